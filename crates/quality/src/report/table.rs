//! A report as a table for a terminal, at most 130 columns wide.

use super::data::{CaseReport, Report};
use super::metric::{Metric, metric};
use super::summary::{
    CaseComparison, compare_cases, deviation, format_value, mean, metrics_with_values, techniques, worst,
};
use crate::text_table::TextTable;

/// Maximum width of the table, columns.
const WIDTH: usize = 130;

/// Metrics that are left out for lack of space.
const PAGE_ONLY: &[&str] =
    &["leak_percent", "peter_panning_cm", "edge_width_ratio", "flicker_zoom", "triangles", "pages"];

/// Metrics whose worst cases are listed.
const WORST_CASES_OF: &[&str] = &["misclassified_percent", "mean_error_percent", "missing_contacts_percent"];

/// Returns a report as a table for a terminal, at most 130 columns wide: a row for each case, the mean and the worst
/// value of each technique, and the worst cases. Long names are truncated.
#[must_use]
pub fn table(report: &Report) -> String {
    let [width_px, height_px] = report.size_px;
    let count = report.cases.len();
    let cases = if count == 1 { "case" } else { "cases" };
    let adapter = cut(&clean(&report.adapter), 90);
    let out = format!("{width_px}x{height_px} pixels, {adapter}, {count} {cases}\n");
    if count == 0 {
        return out;
    }
    let mut metrics = metrics_with_values(report);
    metrics.retain(|metric| !PAGE_ONLY.contains(&metric.name));
    let alignment = "llll".to_owned() + &"r".repeat(metrics.len());
    let cases = report.cases.iter().map(|case| case_row(case, &metrics));
    let rows =
        heading(&metrics).into_iter().chain(cases).chain([Vec::new()]).chain(summary_rows(report, &metrics));
    let all = TextTable { alignment: &alignment, indent: 0, width: WIDTH }.format(rows);
    out + "\n" + &all + &comparison(report) + "\nworst cases\n" + &worst_cases(report)
}

/// Returns a row: scene, light, view and technique, and the numbers.
fn row(names: [&str; 4], numbers: impl Iterator<Item = String>) -> Vec<String> {
    names.into_iter().map(clean).chain(numbers).collect()
}

fn heading(metrics: &[&Metric]) -> [Vec<String>; 2] {
    let line = |index: usize| metrics.iter().map(move |metric| metric.heading[index].to_owned());
    [row([""; 4], line(0)), row(["scene", "light", "view", "technique"], line(1))]
}

fn case_row(case: &CaseReport, metrics: &[&Metric]) -> Vec<String> {
    let numbers = metrics.iter().map(|metric| format_value(metric, (metric.value)(case)));
    row([&case.scene, &case.light, &case.view, &case.technique], numbers)
}

/// Returns the mean and the worst values of each technique.
fn summary_rows(report: &Report, metrics: &[&Metric]) -> Vec<Vec<String>> {
    let values = |label: &str, technique: &str, of: &dyn Fn(&Metric) -> Option<f64>| {
        row([label, "", "", technique], metrics.iter().map(|metric| format_value(metric, of(metric))))
    };
    let both = |technique| {
        let mean = values("mean", technique, &|metric| mean(report, technique, metric));
        let worst = |metric: &Metric| worst(report, technique, metric).map(|(_, value)| value);
        [mean, values("worst", technique, &worst)]
    };
    techniques(report).into_iter().flat_map(both).collect()
}

/// Compares the misclassified pixels of all techniques with those of the first; empty if there is only one technique.
fn comparison(report: &Report) -> String {
    let techniques = techniques(report);
    let (Some((first, others)), Some(metric)) =
        (techniques.split_first(), metric("misclassified_total_percent"))
    else {
        return String::new();
    };
    if others.is_empty() {
        return String::new();
    }
    let compare = |technique: &&str| {
        let CaseComparison { cases, better, equal } = compare_cases(report, technique, first, metric);
        [clean(technique), format!("in {better} of {cases} cases, equal in {equal}")]
    };
    let heading = format!("\n{} lower than {}\n", metric.name, cut(&clean(first), 90));
    heading + &TextTable { alignment: "ll", indent: 2, width: WIDTH }.format(others.iter().map(compare))
}

fn worst_cases(report: &Report) -> String {
    let mut rows = Vec::new();
    for technique in techniques(report) {
        for metric in WORST_CASES_OF.iter().filter_map(|name| metric(name)) {
            let Some((case, value)) = worst(report, technique, metric) else { continue };
            let place = match deviation(metric, value) > 0.0 {
                true => clean(&format!("{}, {}, {}", case.scene, case.light, case.view)),
                false => "all cases".into(),
            };
            rows.push([clean(technique), metric.name.into(), format_value(metric, Some(value)), place]);
        }
    }
    TextTable { alignment: "llrl", indent: 2, width: WIDTH }.format(rows)
}

fn cut(text: &str, width: usize) -> String {
    match text.chars().count() > width {
        true => text.chars().take(width.saturating_sub(1)).chain(['\u{2026}']).collect(),
        false => text.to_owned(),
    }
}

/// Replaces control characters: names in a file may contain line breaks and terminal codes.
fn clean(name: &str) -> String {
    name.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::super::fixture;
    use super::*;

    #[test]
    fn columns_are_aligned_and_at_most_130_wide_and_long_names_are_truncated() {
        let mut report = fixture::report(&[("pcf", 1.0), ("a-technique-with-a-name", 100.0), ("pcf", 0.1)]);
        report.adapter = "an adapter ".repeat(20);
        report.cases[0].scene = "x".repeat(60);
        report.cases[1].light = "y".repeat(60);
        let text = table(&report);
        assert!(text.lines().all(|line| line.chars().count() <= WIDTH), "{text}");
        let lines: Vec<&str> = text.lines().skip(2).take_while(|line| !line.is_empty()).collect();
        assert_eq!(lines.len(), 2 + 3, "{text}");
        assert!(lines.iter().all(|line| line.chars().count() == lines[0].chars().count()), "{text}");
        assert!(lines[2].contains("xx\u{2026}  sun 15 "), "{text}");
        assert!(lines[3].contains("yy\u{2026}  view 1 "), "{text}");
    }

    #[test]
    fn a_missing_value_is_a_dash_and_a_column_without_values_is_left_out() {
        let mut report = fixture::report(&[("pcf", 1.0), ("pcf", 2.0)]);
        report.cases.iter_mut().for_each(|case| case.edges = None);
        report.cases[1].cost = None;
        let text = table(&report);
        let words = |line: &str| line.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let rows: Vec<_> = text.lines().filter(|line| line.contains(" pcf ")).map(words).collect();
        assert!(!text.contains("RMSE"), "{text}");
        assert_eq!(rows[0][rows[0].len() - 3..], ["1.25", "64.0", "20"], "{text}");
        assert_eq!(rows[1][rows[1].len() - 3..], ["-", "-", "-"], "{text}");
        assert_eq!(rows[2][..3], ["mean", "pcf", "1.500"], "{text}");
        assert_eq!(rows[2][rows[2].len() - 3..], ["1.25", "64.0", "20"], "{text}");
    }

    #[test]
    fn the_worst_cases_of_each_technique_are_listed() {
        let text = table(&fixture::report(&[("a", 1.0), ("a", 3.0), ("b", 0.0), ("b", 2.0)]));
        let worst: Vec<_> = text.lines().filter(|line| line.contains("misclassified_percent")).collect();
        assert!(
            worst[0].starts_with("  a ") && worst[0].ends_with(" 3.000  tower, sun 15, view 1"),
            "{text}"
        );
        assert!(
            worst[1].starts_with("  b ") && worst[1].ends_with(" 2.000  tower, sun 15, view 3"),
            "{text}"
        );
        assert!(text.lines().any(|line| line.ends_with(" 0.000  all cases")), "{text}");
    }

    #[test]
    fn techniques_are_compared_with_the_first() {
        let mut report = fixture::report(&[("a", 1.0), ("b", 1.0)]);
        report.cases[1].view = report.cases[0].view.clone();
        report.cases[1].errors.misclassified.total.misclassified_percent = -1.0;
        let text = table(&report);
        assert!(text.contains("\nmisclassified_total_percent lower than a\n  b"), "{text}");
        assert!(text.contains("  in 1 of 1 cases, equal in 0\n"), "{text}");
        assert!(!table(&fixture::report(&[("a", 1.0)])).contains("lower than"));
    }

    #[test]
    fn terminal_codes_in_names_do_not_reach_the_terminal() {
        let mut report = fixture::report(&[("pcf", 1.0)]);
        report.cases[0].scene = "bad\u{1b}[31m\nname".into();
        assert!(!table(&report).replace('\n', "").contains(char::is_control));
        assert!(table(&report).contains("bad\u{fffd}[31m\u{fffd}name"));
    }

    #[test]
    fn the_first_line_has_size_adapter_and_number_of_cases() {
        let mut report = fixture::report(&[("pcf", 1.0)]);
        assert_eq!(table(&report).lines().next(), Some("640x360 pixels, llvmpipe, 1 case"));
        report.cases.clear();
        assert_eq!(table(&report), "640x360 pixels, llvmpipe, 0 cases\n");
    }
}
