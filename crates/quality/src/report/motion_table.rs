//! A report of motion as tables: for a terminal, and in Markdown.

use super::data::{MotionCase, MotionReport, Moving};
use crate::metrics::CHANGE;
use crate::text_table::TextTable;

/// Maximum width of the table, columns.
const WIDTH: usize = 130;

/// Headings of the numbers.
const NUMBERS: [&str; 7] =
    ["excess mean", "excess p99", "changed", "soft truth", "soft ratio", "hard truth", "hard ratio"];

/// Returns a report as a table for a terminal, at most 130 columns wide: a row for each case, and the means of each technique.
#[must_use]
pub fn motion_table(report: &MotionReport) -> String {
    let [width_px, height_px] = report.size_px;
    let count = report.cases.len();
    let cases = if count == 1 { "case" } else { "cases" };
    let head = format!("{width_px}x{height_px} pixels, {}, {count} {cases}\n\n", report.adapter);
    let names = |names: [&str; 5]| names.map(|name| name.replace(char::is_control, "\u{fffd}"));
    let row = |first: [&str; 5], numbers: [String; 7]| [&names(first)[..], &numbers].concat();
    let case = |case: &MotionCase| {
        row([&case.scene, &case.light, &case.view, &case.technique, case.moving.name()], numbers(&[case]))
    };
    let means = groups(report)
        .map(|(technique, moving, cases)| row(["mean", "", "", technique, moving.name()], numbers(&cases)));
    let heading = row(["scene", "light", "view", "technique", "moving"], NUMBERS.map(str::to_owned));
    let rows = std::iter::once(heading).chain(report.cases.iter().map(case)).chain([Vec::new()]).chain(means);
    head + &TextTable { alignment: "lllllrrrrrrr", indent: 0, width: WIDTH }.format(rows)
}

/// Returns the means of each technique on each path as a Markdown table.
#[must_use]
pub fn motion_markdown(report: &MotionReport) -> String {
    let heading = format!(
        "| technique | moving | excess mean | excess p99 | changed by more than {:.0} % | soft truth | soft ratio | hard truth | hard ratio |\n\
         | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n",
        CHANGE * 100.0
    );
    let row = |(technique, moving, cases): (&str, Moving, Vec<&MotionCase>)| {
        format!("| `{technique}` | {} | {} |\n", moving.name(), numbers(&cases).join(" | "))
    };
    heading + &groups(report).map(row).collect::<String>()
}

/// Returns the cases of each path and technique.
fn groups(report: &MotionReport) -> impl Iterator<Item = (&str, Moving, Vec<&MotionCase>)> {
    let mut techniques: Vec<&str> = Vec::new();
    for case in &report.cases {
        if !techniques.contains(&case.technique.as_str()) {
            techniques.push(&case.technique);
        }
    }
    let all = Moving::ALL
        .into_iter()
        .flat_map(move |moving| techniques.clone().into_iter().map(move |technique| (technique, moving)));
    all.filter_map(|(technique, moving)| {
        let of_group = |case: &&MotionCase| case.technique == technique && case.moving == moving;
        let cases: Vec<&MotionCase> = report.cases.iter().filter(of_group).collect();
        (!cases.is_empty()).then_some((technique, moving, cases))
    })
}

/// Returns the means over cases: mean and 99th percentile of the excess, pixels that changed, and those of each
/// truth with their ratio.
fn numbers(cases: &[&MotionCase]) -> [String; 7] {
    let mean = |value: fn(&MotionCase) -> f64| {
        cases.iter().map(|case| value(case)).sum::<f64>() / cases.len().max(1) as f64
    };
    let changed = mean(|case| case.stability.changed);
    let [soft, hard] = [mean(|case| case.stability.truth_changed), mean(|case| case.stability.hard_changed)];
    let ratio = |truth: f64| if truth > 0.0 { format!("{:.1}", changed / truth) } else { "-".to_owned() };
    [
        format!("{:.5}", mean(|case| case.stability.excess.mean)),
        format!("{:.4}", mean(|case| case.stability.excess.p99)),
        format!("{changed:.1}"),
        format!("{soft:.1}"),
        ratio(soft),
        format!("{hard:.1}"),
        ratio(hard),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::{Stability, Summary};

    fn case(scene: &str, technique: &str, moving: Moving, changed: f64) -> MotionCase {
        let stability = Stability {
            excess: Summary { count: 10, mean: 0.001, p99: 0.05 },
            changed,
            truth_changed: if moving == Moving::Sun { 4.0 } else { 0.0 },
            hard_changed: if moving == Moving::Sun { 1.0 } else { 0.0 },
        };
        let (scene, technique) = (scene.to_owned(), technique.to_owned());
        MotionCase { scene, light: "sun 30\u{b0}".into(), view: "near".into(), technique, moving, stability }
    }

    fn report() -> MotionReport {
        MotionReport {
            version: 1,
            adapter: "test".into(),
            size_px: [48, 27],
            settings: Default::default(),
            cases: vec![
                case("cube", "pcf", Moving::Sun, 8.0),
                case("cube", "raytraced", Moving::Sun, 4.0),
                case("cube", "pcf", Moving::Camera, 0.0),
                case("a\nline", "pcf", Moving::Sun, 24.0),
            ],
        }
    }

    #[test]
    fn the_table_has_each_case_and_the_means_of_each_technique() {
        let table = motion_table(&report());
        assert!(table.starts_with("48x27 pixels, test, 4 cases\n\nscene"), "{table}");
        assert_eq!(table.lines().count(), 2 + 1 + 4 + 1 + 3, "{table}");
        let last = table.lines().last().unwrap_or_default();
        assert_eq!(last.split_whitespace().collect::<Vec<_>>()[1..3], ["raytraced", "sun"], "{table}");
    }

    #[test]
    fn the_markdown_table_has_the_means() {
        let rows = motion_markdown(&report());
        let lines: Vec<&str> = rows.lines().skip(2).collect();
        assert_eq!(
            lines,
            [
                "| `pcf` | camera | 0.00100 | 0.0500 | 0.0 | 0.0 | - | 0.0 | - |",
                "| `pcf` | sun | 0.00100 | 0.0500 | 16.0 | 4.0 | 4.0 | 1.0 | 16.0 |",
                "| `raytraced` | sun | 0.00100 | 0.0500 | 4.0 | 4.0 | 1.0 | 1.0 | 4.0 |",
            ]
        );
    }
}
