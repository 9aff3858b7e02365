//! Aggregates all cases of a technique.

use std::cmp::Ordering;

use super::data::{CaseReport, Report};
use super::metric::{METRICS, Metric};

/// Returns the techniques, in the order in which they first appear.
#[must_use]
pub fn techniques(report: &Report) -> Vec<&str> {
    let mut names = Vec::new();
    for case in &report.cases {
        if !names.contains(&case.technique.as_str()) {
            names.push(case.technique.as_str());
        }
    }
    names
}

/// Returns the metrics for which some case has a value, in the order of [`METRICS`].
#[must_use]
pub fn metrics_with_values(report: &Report) -> Vec<&'static Metric> {
    METRICS.iter().filter(|metric| report.cases.iter().any(|case| (metric.value)(case).is_some())).collect()
}

/// Returns the mean over the cases of a technique that have a value; `None` if there are none.
#[must_use]
pub fn mean(report: &Report, technique: &str, metric: &Metric) -> Option<f64> {
    let add = |(sum, count): (f64, u32), (_, value)| (sum + value, count + 1);
    let (sum, count) = values(report, technique, metric).fold((0.0, 0), add);
    (count > 0).then(|| sum / f64::from(count))
}

/// Returns a technique's worst case, by [`deviation`], and its value: the first one of several, `None` if no case has a
/// value. Of all metrics but `edge_width_ratio` it is the one with the highest value.
#[must_use]
pub fn worst<'r>(report: &'r Report, technique: &str, metric: &Metric) -> Option<(&'r CaseReport, f64)> {
    let deviation = |(_, value): &(_, f64)| deviation(metric, *value);
    values(report, technique, metric)
        .reduce(|a, b| if deviation(&b).total_cmp(&deviation(&a)).is_gt() { b } else { a })
}

/// Returns how far a value is from the ideal one, 0; higher is worse. For `edge_width_ratio`, twice the width counts as
/// much as half the width; for all other metrics it is the value.
#[must_use]
pub fn deviation(metric: &Metric, value: f64) -> f64 {
    if metric.name == "edge_width_ratio" { value.max(value.recip()) - 1.0 } else { value }
}

/// Comparison of a technique's cases with those of another one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CaseComparison {
    /// Number of cases in which both have a value.
    pub cases: usize,
    /// Number of cases in which the technique has the lower [`deviation`].
    pub better: usize,
    /// Number of cases in which both have the same.
    pub equal: usize,
}

/// Compares the values of two techniques, case by case.
#[must_use]
pub fn compare_cases(report: &Report, technique: &str, other: &str, metric: &Metric) -> CaseComparison {
    let place = |case: &CaseReport| [&case.scene, &case.light, &case.view].map(String::clone);
    let others: Vec<_> = values(report, other, metric).map(|(case, value)| (place(case), value)).collect();
    let mut comparison = CaseComparison::default();
    for (case, value) in values(report, technique, metric) {
        let at = place(case);
        let Some((_, other)) = others.iter().find(|(place, _)| *place == at) else { continue };
        comparison.cases += 1;
        match deviation(metric, value).total_cmp(&deviation(metric, *other)) {
            Ordering::Less => comparison.better += 1,
            Ordering::Equal => comparison.equal += 1,
            Ordering::Greater => {}
        }
    }
    comparison
}

/// Formats a value with the decimals of its metric, a dash if there is none.
pub(super) fn format_value(metric: &Metric, value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.*}", metric.decimals))
}

fn values<'r>(
    report: &'r Report,
    technique: &str,
    metric: &Metric,
) -> impl Iterator<Item = (&'r CaseReport, f64)> {
    let cases = report.cases.iter().filter(move |case| case.technique == technique);
    cases.filter_map(|case| Some((case, (metric.value)(case)?)))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::super::{fixture, metric};
    use super::*;

    #[test]
    fn techniques_come_in_the_order_of_their_first_cases() {
        let report = fixture::report(&[("b", 1.0), ("a", 1.0), ("b", 2.0)]);
        assert_eq!(techniques(&report), ["b", "a"]);
    }

    #[test]
    fn a_missing_value_does_not_count_in_the_mean_or_as_the_worst() {
        let mut report = fixture::report(&[("pcf", 1.0), ("pcf", 2.0), ("pcf", 9.0)]);
        report.cases[0].cost = None;
        report.cases[1].cost.as_mut().unwrap().gpu_ms = Some(4.0);
        report.cases[2].cost.as_mut().unwrap().gpu_ms = Some(2.0);
        let gpu_ms = metric("gpu_ms").unwrap();
        assert_eq!(mean(&report, "pcf", gpu_ms), Some(3.0));
        assert_eq!(worst(&report, "pcf", gpu_ms), Some((&report.cases[1], 4.0)));
        assert_eq!(mean(&report, "none", gpu_ms), None);
        assert_eq!(worst(&report, "none", gpu_ms), None);
    }

    #[test]
    fn the_first_of_several_worst_cases_of_the_technique_is_returned() {
        let report = fixture::report(&[("other", 9.0), ("pcf", 1.0), ("pcf", 5.0), ("pcf", 5.0)]);
        let (case, value) = worst(&report, "pcf", metric("misclassified_percent").unwrap()).unwrap();
        assert!(std::ptr::eq(case, &raw const report.cases[2]));
        assert_eq!(value, 5.0);
    }

    #[test]
    fn edges_that_are_too_hard_are_as_bad_as_edges_that_are_too_soft() {
        let mut report = fixture::report(&[("pcf", 1.0), ("pcf", 1.0), ("pcf", 1.0)]);
        for (case, ratio) in report.cases.iter_mut().zip([2.0, 0.25, 1.0]) {
            case.edges.as_mut().unwrap().width_ratio = Some(ratio);
        }
        let width = metric("edge_width_ratio").unwrap();
        assert_eq!(deviation(width, 2.0), deviation(width, 0.5));
        assert_eq!(worst(&report, "pcf", width).unwrap().1, 0.25);
    }

    #[test]
    fn techniques_are_compared_in_the_cases_that_both_have() {
        let mut report =
            fixture::report(&[("pcf", 1.0), ("a", 0.5), ("pcf", 1.0), ("a", 1.0), ("pcf", 1.0), ("a", 2.0)]);
        for (index, case) in report.cases.iter_mut().enumerate() {
            case.view = format!("view {}", index / 2);
        }
        let wrong = metric("misclassified_percent").unwrap();
        assert_eq!(
            compare_cases(&report, "a", "pcf", wrong),
            CaseComparison { cases: 3, better: 1, equal: 1 }
        );
        report.cases.remove(0);
        assert_eq!(
            compare_cases(&report, "a", "pcf", wrong),
            CaseComparison { cases: 2, better: 0, equal: 1 }
        );
        assert_eq!(compare_cases(&report, "none", "pcf", wrong), CaseComparison::default());
    }

    #[test]
    fn only_metrics_with_a_value_are_measured() {
        let mut report = fixture::report(&[("pcf", 1.0), ("pcf", 1.0)]);
        report.cases.iter_mut().for_each(|case| case.seam = None);
        report.cases[0].cost = None;
        let names: Vec<_> = metrics_with_values(&report).iter().map(|metric| metric.name).collect();
        assert!(!names.contains(&"seam") && names.contains(&"texture_mib"), "{names:?}");
    }
}
