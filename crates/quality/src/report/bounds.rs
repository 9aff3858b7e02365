//! Upper bounds that a report is checked against.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::data::Report;
use super::metric::{METRICS, Metric, metric};
use super::summary::{deviation, format_value, mean, worst};
use shadowgraph::ron_file;

use crate::Error;

/// Upper bounds of the numbers of a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bounds {
    /// The bounds, in any order.
    pub bounds: Vec<Bound>,
}

/// Bound of one metric of one technique.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Bound {
    /// Name of the technique.
    pub technique: String,
    /// Name of the metric, one of [`METRICS`].
    pub metric: String,
    /// Maximum of the mean over all cases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean: Option<f64>,
    /// Maximum of every case.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worst: Option<f64>,
}

impl Bounds {
    /// Reads bounds from RON; errors name `file`.
    ///
    /// # Errors
    /// [`Error::File`] with line and column, or the unknown metric.
    pub fn parse(text: &str, file: &Path) -> Result<Self, Error> {
        let file = file.display().to_string();
        let bounds: Self = ron_file::parse_file(&file, text)?;
        for (index, bound) in bounds.bounds.iter().enumerate() {
            let error = |problem| ron_file::field_error(&file, text, &format!("bounds.{index}"), problem);
            bound.check().map_err(error)?;
        }
        Ok(bounds)
    }

    /// Returns a line for each number of a report that exceeds its bound or is missing.
    #[must_use]
    pub fn violations(&self, report: &Report) -> Vec<String> {
        self.bounds.iter().flat_map(|bound| bound.violations(report)).collect()
    }
}

impl Bound {
    fn check(&self) -> Result<(), String> {
        if metric(&self.metric).is_none() {
            let known: Vec<_> = METRICS.iter().map(|metric| metric.name).collect();
            return Err(format!("unknown metric `{}`; expected one of: {}", self.metric, known.join(", ")));
        }
        let given = [("mean", self.mean), ("worst", self.worst)];
        let invalid = given
            .into_iter()
            .find(|(_, bound)| bound.is_some_and(|bound| !(0.0..=f64::MAX).contains(&bound)));
        match invalid {
            Some((what, bound)) => {
                let bound = bound.unwrap_or_default();
                let name = format!("{} {}", self.technique, self.metric);
                Err(format!("{name}: invalid value {bound} of {what}; allowed: 0 and above"))
            }
            None if self.mean.is_none() && self.worst.is_none() => {
                Err(format!("{} {}: expected mean, worst or both", self.technique, self.metric))
            }
            None => Ok(()),
        }
    }

    fn violations(&self, report: &Report) -> Vec<String> {
        let Some(metric) = metric(&self.metric) else { return Vec::new() };
        let name = format!("{} {}", self.technique, self.metric);
        let (mean, worst) = (mean(report, &self.technique, metric), worst(report, &self.technique, metric));
        let (Some(mean), Some((case, worst))) = (mean, worst) else {
            return vec![format!("{name}: no case of the report has a value")];
        };
        let location = format!(" ({}, {}, {})", case.scene, case.light, case.view);
        let of_mean = describe_violation(metric, "mean", mean, self.mean, "");
        let of_worst = describe_violation(metric, "worst", worst, self.worst, &location);
        [of_mean, of_worst].into_iter().flatten().map(|what| format!("{name}: {what}")).collect()
    }
}

/// Describes a value that exceeds its bound or is NaN; `None` if it is within.
fn describe_violation(
    metric: &Metric,
    what: &str,
    value: f64,
    bound: Option<f64>,
    location: &str,
) -> Option<String> {
    let bound =
        bound.filter(|&bound| deviation(metric, value).total_cmp(&deviation(metric, bound)).is_gt())?;
    // Enough digits to distinguish the two.
    let formatted = match format_value(metric, Some(value)) {
        text if text == format_value(metric, Some(bound)) => value.to_string(),
        text => text,
    };
    Some(format!("{what} {formatted}{location} exceeds the bound {bound}"))
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
    fn a_report_within_its_bounds_has_no_violations() {
        let report = fixture::report(&[("pcf", 1.0), ("pcf", 3.0)]);
        let text =
            r#"(bounds: [(technique: "pcf", metric: "misclassified_percent", mean: 2.0, worst: 3.0)])"#;
        assert_eq!(bounds(text).unwrap().violations(&report), Vec::<String>::new());
    }

    #[test]
    fn a_violation_names_the_worst_case() {
        let report = fixture::report(&[("pcf", 1.0), ("pcf", 3.0), ("other", 9.0)]);
        let text =
            r#"(bounds: [(technique: "pcf", metric: "misclassified_percent", mean: 1.9, worst: 2.9999)])"#;
        let violations = bounds(text).unwrap().violations(&report);
        assert_eq!(
            violations,
            [
                "pcf misclassified_percent: mean 2.000 exceeds the bound 1.9",
                "pcf misclassified_percent: worst 3 (tower, sun 15, view 1) exceeds the bound 2.9999",
            ]
        );
    }

    #[test]
    fn a_missing_value_or_nan_violates_its_bound() {
        let mut report = fixture::report(&[("pcf", f64::NAN)]);
        report.cases[0].seam = None;
        let text = r#"(bounds: [
            (technique: "pcf", metric: "seam", mean: 1),
            (technique: "evsm", metric: "misclassified_percent", worst: 1),
            (technique: "pcf", metric: "misclassified_percent", worst: 1),
        ])"#;
        let violations = bounds(text).unwrap().violations(&report);
        assert_eq!(violations.len(), 3, "{violations:?}");
        assert_eq!(violations[0], "pcf seam: no case of the report has a value");
    }

    #[test]
    fn invalid_bounds_are_errors_of_one_line() {
        let error = bounds(r#"(bounds: [(technique: "pcf", metric: "blur", worst: 1)])"#).unwrap_err();
        assert!(
            error.starts_with("my.ron:1:11: unknown metric `blur`; expected one of: misclassified_percent, "),
            "{error}"
        );
        for (given, expected) in [
            ("worst: NaN", "pcf seam: invalid value NaN of worst; allowed: 0 and above"),
            ("mean: -1", "pcf seam: invalid value -1 of mean"),
            ("", "pcf seam: expected mean, worst or both"),
        ] {
            let text = format!(r#"(bounds: [(technique: "pcf", metric: "seam", {given})])"#);
            let error = bounds(&text).unwrap_err();
            assert!(error.contains(expected), "{error}");
        }
        let error = bounds("(bounds: [(technique: 3)])").unwrap_err();
        assert!(error.starts_with("my.ron:1:") && error.lines().count() == 1, "{error}");
    }
}
