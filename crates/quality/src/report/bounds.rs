//! Bounds that a report is checked against.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::data::Report;
use super::metric::{METRICS, Metric, metric};
use super::summary::{mean, off, shown, worst};
use shadowgraph::ron_file;

use crate::Error;

/// What the numbers of a report may be at most.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// In any order.
    pub bounds: Vec<Bound>,
}

/// The bound of a technique's metric.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// The technique's name.
    pub technique: String,
    /// The metric's name, one of [`METRICS`].
    pub metric: String,
    /// The most that the mean over all cases may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// The most that any case may be.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<f64>,
}

impl Bounds {
    /// Reads bounds from RON; `place` is what errors name.
    ///
    /// # Errors
    /// [`Error::Cases`] with line and column, or the metric that there is not.
    pub fn parse(text: &str, place: &Path) -> Result<Self, Error> {
        let file = place.display().to_string();
        let bounds: Self = ron_file::parse_file(&file, text)?;
        for (index, bound) in bounds.bounds.iter().enumerate() {
            let wrong = |problem| ron_file::field_error(&file, text, &format!("bounds.{index}"), problem);
            bound.check().map_err(wrong)?;
        }
        Ok(bounds)
    }

    /// Returns a sentence for each number of a report that is beyond its bound, or that is missing.
    #[must_use]
    pub fn broken_by(&self, report: &Report) -> Vec<String> {
        self.bounds.iter().flat_map(|bound| bound.broken_by(report)).collect()
    }
}

impl Bound {
    fn check(&self) -> Result<(), String> {
        if metric(&self.metric).is_none() {
            let known: Vec<_> = METRICS.iter().map(|metric| metric.name).collect();
            return Err(format!("there is no metric `{}`; there is: {}", self.metric, known.join(", ")));
        }
        let given = [("mean", self.mean), ("worst", self.worst)];
        let wrong = given
            .into_iter()
            .find(|(_, bound)| bound.is_some_and(|bound| !(0.0..=f64::MAX).contains(&bound)));
        match wrong {
            Some((what, bound)) => {
                let bound = bound.unwrap_or_default();
                let name = format!("{} {}", self.technique, self.metric);
                Err(format!("{name}: {what} is {bound}; give a number of 0 or above"))
            }
            None if self.mean.is_none() && self.worst.is_none() => {
                Err(format!("{} {}: give mean, worst or both", self.technique, self.metric))
            }
            None => Ok(()),
        }
    }

    fn broken_by(&self, report: &Report) -> Vec<String> {
        let Some(metric) = metric(&self.metric) else { return Vec::new() };
        let name = format!("{} {}", self.technique, self.metric);
        let (mean, worst) = (mean(report, &self.technique, metric), worst(report, &self.technique, metric));
        let (Some(mean), Some((case, worst))) = (mean, worst) else {
            return vec![format!("{name}: no case of the report has a value")];
        };
        let place = format!(" ({}, {}, {})", case.scene, case.light, case.view);
        let of_mean = beyond(metric, "mean", mean, self.mean, "");
        let of_worst = beyond(metric, "worst", worst, self.worst, &place);
        [of_mean, of_worst].into_iter().flatten().map(|what| format!("{name}: {what}")).collect()
    }
}

/// Says so if a value is beyond its bound; a value that is no number is.
fn beyond(metric: &Metric, what: &str, value: f64, bound: Option<f64>, place: &str) -> Option<String> {
    let bound = bound.filter(|&bound| off(metric, value).total_cmp(&off(metric, bound)).is_gt())?;
    // As many digits as tell the two apart.
    let shown_value = match shown(metric, Some(value)) {
        text if text == shown(metric, Some(bound)) => value.to_string(),
        text => text,
    };
    Some(format!("{what} {shown_value}{place} is beyond the bound {bound}"))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::super::fixture;
    use super::*;

    fn bounds(text: &str) -> Result<Bounds, String> {
        Bounds::parse(text, Path::new("my.ron")).map_err(|error| error.to_string())
    }

    #[test]
    fn a_report_within_its_bounds_breaks_none() {
        let report = fixture::report(&[("pcf", 1.0), ("pcf", 3.0)]);
        let text =
            r#"(bounds: [(technique: "pcf", metric: "misclassified_percent", mean: 2.0, worst: 3.0)])"#;
        assert_eq!(bounds(text).unwrap().broken_by(&report), Vec::<String>::new());
    }

    #[test]
    fn what_got_worse_is_named_with_its_case() {
        let report = fixture::report(&[("pcf", 1.0), ("pcf", 3.0), ("other", 9.0)]);
        let text =
            r#"(bounds: [(technique: "pcf", metric: "misclassified_percent", mean: 1.9, worst: 2.9999)])"#;
        let broken = bounds(text).unwrap().broken_by(&report);
        assert_eq!(
            broken,
            [
                "pcf misclassified_percent: mean 2.000 is beyond the bound 1.9",
                "pcf misclassified_percent: worst 3 (tower, sun 15, view 1) is beyond the bound 2.9999",
            ]
        );
    }

    #[test]
    fn a_number_that_is_missing_or_none_breaks_its_bound() {
        let mut report = fixture::report(&[("pcf", f64::NAN)]);
        report.cases[0].seam = None;
        let text = r#"(bounds: [
            (technique: "pcf", metric: "seam", mean: 1),
            (technique: "evsm", metric: "misclassified_percent", worst: 1),
            (technique: "pcf", metric: "misclassified_percent", worst: 1),
        ])"#;
        let broken = bounds(text).unwrap().broken_by(&report);
        assert_eq!(broken.len(), 3, "{broken:?}");
        assert_eq!(broken[0], "pcf seam: no case of the report has a value");
    }

    #[test]
    fn wrong_bounds_are_refused_in_one_line() {
        let error = bounds(r#"(bounds: [(technique: "pcf", metric: "blur", worst: 1)])"#).unwrap_err();
        assert!(
            error.starts_with("my.ron:1:11: there is no metric `blur`; there is: misclassified_percent, "),
            "{error}"
        );
        for (given, expected) in [
            ("worst: NaN", "pcf seam: worst is NaN; give a number of 0 or above"),
            ("mean: -1", "pcf seam: mean is -1; give"),
            ("", "pcf seam: give mean, worst or both"),
        ] {
            let text = format!(r#"(bounds: [(technique: "pcf", metric: "seam", {given})])"#);
            let error = bounds(&text).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        let error = bounds("(bounds: [(technique: 3)])").unwrap_err();
        assert!(error.starts_with("my.ron:1:") && error.lines().count() == 1, "{error}");
    }
}
