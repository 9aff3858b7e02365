//! What all cases of a technique come to.

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
pub fn measured(report: &Report) -> Vec<&'static Metric> {
    METRICS.iter().filter(|metric| report.cases.iter().any(|case| (metric.of)(case).is_some())).collect()
}

/// Returns the mean over those cases of a technique that have a value, `None` if none has one.
#[must_use]
pub fn mean(report: &Report, technique: &str, metric: &Metric) -> Option<f64> {
    let add = |(sum, count): (f64, u32), (_, value)| (sum + value, count + 1);
    let (sum, count) = values(report, technique, metric).fold((0.0, 0), add);
    (count > 0).then(|| sum / f64::from(count))
}

/// Returns a technique's worst case, by [`off`], and its value: the first one of several, `None` if no case has a
/// value. Of all metrics but `edge_width_ratio` it is the one with the highest value.
#[must_use]
pub fn worst<'r>(report: &'r Report, technique: &str, metric: &Metric) -> Option<(&'r CaseReport, f64)> {
    let off = |(_, value): &(_, f64)| off(metric, *value);
    values(report, technique, metric).reduce(|a, b| if off(&b).total_cmp(&off(&a)).is_gt() { b } else { a })
}

/// Returns how far a value is from right, which is 0; more is worse. Of `edge_width_ratio`, twice as wide is as far
/// as half as wide; of all other metrics it is the value.
#[must_use]
pub fn off(metric: &Metric, value: f64) -> f64 {
    if metric.name == "edge_width_ratio" { value.max(value.recip()) - 1.0 } else { value }
}

/// How a technique's cases compare with another one's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Compared {
    /// How many cases both have a value in.
    pub cases: usize,
    /// In how many of them the technique is less [`off`].
    pub better: usize,
    /// In how many of them both are as far off.
    pub equal: usize,
}

/// Compares a technique's values with another one's, case by case.
#[must_use]
pub fn compared(report: &Report, technique: &str, other: &str, metric: &Metric) -> Compared {
    let place = |case: &CaseReport| [&case.scene, &case.light, &case.view].map(String::clone);
    let others: Vec<_> = values(report, other, metric).map(|(case, value)| (place(case), value)).collect();
    let mut compared = Compared::default();
    for (case, value) in values(report, technique, metric) {
        let at = place(case);
        let Some((_, other)) = others.iter().find(|(place, _)| *place == at) else { continue };
        compared.cases += 1;
        match off(metric, value).total_cmp(&off(metric, *other)) {
            Ordering::Less => compared.better += 1,
            Ordering::Equal => compared.equal += 1,
            Ordering::Greater => {}
        }
    }
    compared
}

/// A value with its metric's decimals, a dash if there is none.
pub(super) fn shown(metric: &Metric, value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.*}", metric.decimals))
}

fn values<'r>(
    report: &'r Report,
    technique: &str,
    metric: &Metric,
) -> impl Iterator<Item = (&'r CaseReport, f64)> {
    let cases = report.cases.iter().filter(move |case| case.technique == technique);
    cases.filter_map(|case| Some((case, (metric.of)(case)?)))
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
    fn the_first_of_several_worst_cases_is_named_and_only_those_of_the_technique_count() {
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
        assert_eq!(off(width, 2.0), off(width, 0.5));
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
        assert_eq!(compared(&report, "a", "pcf", wrong), Compared { cases: 3, better: 1, equal: 1 });
        report.cases.remove(0);
        assert_eq!(compared(&report, "a", "pcf", wrong), Compared { cases: 2, better: 0, equal: 1 });
        assert_eq!(compared(&report, "none", "pcf", wrong), Compared::default());
    }

    #[test]
    fn only_metrics_with_a_value_are_measured() {
        let mut report = fixture::report(&[("pcf", 1.0), ("pcf", 1.0)]);
        report.cases.iter_mut().for_each(|case| case.seam = None);
        report.cases[0].cost = None;
        let names: Vec<_> = measured(&report).iter().map(|metric| metric.name).collect();
        assert!(!names.contains(&"seam") && names.contains(&"texture_mib"), "{names:?}");
    }
}
