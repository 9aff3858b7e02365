//! A report as a table for a terminal, at most 130 columns wide.

use std::fmt::Write as _;

use super::data::{CaseReport, Report};
use super::metric::{Metric, metric};
use super::summary::{
    CaseComparison, compare_cases, deviation, format_value, mean, metrics_with_values, techniques, worst,
};

/// Maximum width of the table, columns.
const WIDTH: usize = 130;

/// Minimum width of names.
const NAME_WIDTH: usize = 4;

/// Separator of columns.
const GAP: &str = "  ";

/// Metrics that are left out for lack of space.
const PAGE_ONLY: &[&str] =
    &["leak_percent", "peter_panning_cm", "edge_width_ratio", "flicker_zoom", "triangles"];

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
    let mut out = format!("{width_px}x{height_px} pixels, {adapter}, {count} {cases}\n");
    if count == 0 {
        return out;
    }
    let mut metrics = metrics_with_values(report);
    metrics.retain(|metric| !PAGE_ONLY.contains(&metric.name));
    let cases = report.cases.iter().map(|case| case_row(case, &metrics)).collect();
    let sections: [Vec<Row>; 3] = [heading(&metrics), cases, summary_rows(report, &metrics)];
    let widths = Widths::new(&sections);
    for (index, section) in sections.iter().enumerate() {
        out.push_str(if index == 1 { "" } else { "\n" });
        for row in section {
            widths.write(&mut out, row);
        }
    }
    out + &comparison(report, widths.names[3]) + "\nworst cases\n" + &worst_cases(report, widths.names[3])
}

/// A row of the table: scene, light, view and technique, and the numbers.
struct Row {
    names: [String; 4],
    numbers: Vec<String>,
}

fn heading(metrics: &[&Metric]) -> Vec<Row> {
    let line = |names: [&str; 4], index: usize| Row {
        names: names.map(str::to_owned),
        numbers: metrics.iter().map(|metric| metric.heading[index].to_owned()).collect(),
    };
    vec![line([""; 4], 0), line(["scene", "light", "view", "technique"], 1)]
}

fn case_row(case: &CaseReport, metrics: &[&Metric]) -> Row {
    let names = [&case.scene, &case.light, &case.view, &case.technique].map(|name| clean(name));
    Row { names, numbers: metrics.iter().map(|metric| format_value(metric, (metric.value)(case))).collect() }
}

/// Returns the mean and the worst values of each technique.
fn summary_rows(report: &Report, metrics: &[&Metric]) -> Vec<Row> {
    let row = |label: &str, technique: &str, of: &dyn Fn(&Metric) -> Option<f64>| Row {
        names: [label.into(), String::new(), String::new(), clean(technique)],
        numbers: metrics.iter().map(|metric| format_value(metric, of(metric))).collect(),
    };
    let both = |technique| {
        let mean = row("mean", technique, &|metric| mean(report, technique, metric));
        [mean, row("worst", technique, &|metric| worst(report, technique, metric).map(|(_, value)| value))]
    };
    techniques(report).into_iter().flat_map(both).collect()
}

/// Compares the misclassified pixels of all techniques with those of the first; empty if there is only one technique.
fn comparison(report: &Report, technique_width: usize) -> String {
    let techniques = techniques(report);
    let (Some((first, others)), Some(metric)) =
        (techniques.split_first(), metric("misclassified_total_percent"))
    else {
        return String::new();
    };
    if others.is_empty() {
        return String::new();
    }
    let name = |technique: &str| cut(&clean(technique), technique_width);
    let mut out = format!("\n{} lower than {}\n", metric.name, name(first));
    for technique in others {
        let CaseComparison { cases, better, equal } = compare_cases(report, technique, first, metric);
        let name = name(technique);
        let _ = writeln!(out, "  {name:<technique_width$}  in {better} of {cases} cases, equal in {equal}");
    }
    out
}

fn worst_cases(report: &Report, technique_width: usize) -> String {
    let mut out = String::new();
    for technique in techniques(report) {
        for metric in WORST_CASES_OF.iter().filter_map(|name| metric(name)) {
            let Some((case, value)) = worst(report, technique, metric) else { continue };
            let place = match deviation(metric, value) > 0.0 {
                true => clean(&format!("{}, {}, {}", case.scene, case.light, case.view)),
                false => "all cases".into(),
            };
            let name = cut(&clean(technique), technique_width);
            let value = format_value(metric, Some(value));
            let line = format!("  {name:<technique_width$}  {:<26}{value:>8}  {place}", metric.name);
            let _ = writeln!(out, "{}", cut(&line, WIDTH));
        }
    }
    out
}

/// Widths of the columns.
struct Widths {
    names: [usize; 4],
    numbers: Vec<usize>,
}

impl Widths {
    /// Fits columns to their widest cell, then shortens the widest column of names until the table fits.
    fn new(sections: &[Vec<Row>]) -> Self {
        let rows = || sections.iter().flatten();
        let widest = |cell: &dyn Fn(&Row) -> usize| rows().map(cell).max().unwrap_or(0);
        let count = rows().map(|row| row.numbers.len()).max().unwrap_or(0);
        let mut names = [0, 1, 2, 3].map(|column| widest(&|row| chars(&row.names[column])));
        let numbers: Vec<_> = (0..count).map(|column| widest(&|row| chars(&row.numbers[column]))).collect();
        let taken = numbers.iter().sum::<usize>() + GAP.len() * (names.len() + count - 1);
        while names.iter().sum::<usize>() + taken > WIDTH {
            match names.iter_mut().max() {
                Some(widest) if *widest > NAME_WIDTH => *widest -= 1,
                _ => break,
            }
        }
        Self { names, numbers }
    }

    fn write(&self, out: &mut String, row: &Row) {
        let names = row.names.iter().zip(&self.names);
        let names = names.map(|(name, &width)| format!("{:<width$}", cut(name, width)));
        let numbers =
            row.numbers.iter().zip(&self.numbers).map(|(number, width)| format!("{number:>width$}"));
        let cells: Vec<_> = names.chain(numbers).collect();
        let _ = writeln!(out, "{}", cells.join(GAP).trim_end());
    }
}

fn chars(text: &str) -> usize {
    text.chars().count()
}

fn cut(text: &str, width: usize) -> String {
    match chars(text) > width {
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
        assert!(text.lines().all(|line| chars(line) <= WIDTH), "{text}");
        let lines: Vec<&str> = text.lines().skip(2).take_while(|line| !line.is_empty()).collect();
        assert_eq!(lines.len(), 2 + 3, "{text}");
        assert!(lines.iter().all(|line| chars(line) == chars(lines[0])), "{text}");
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
