//! The mean and the worst case of each technique, a row for each metric.

use super::super::data::Report;
use super::super::metric::Metric;
use super::super::summary::{deviation, format_value, mean, worst};
use super::html::{case_id, escape, label};

/// Headings of one technique's columns.
pub(super) const COLUMNS: &str = r#"<th scope="col" class="n">mean</th><th scope="col" class="n">worst</th>"#;

/// Returns the headings above them, the names of techniques.
pub(super) fn names(techniques: &[&str]) -> String {
    let name = |name: &&str| format!(r#"<th scope="colgroup" colspan="2">{}</th>"#, escape(name));
    techniques.iter().map(name).collect()
}

pub(super) fn rows(report: &Report, techniques: &[&str], metrics: &[&Metric]) -> String {
    let row = |metric: &&Metric| {
        let cells: String = techniques.iter().map(|technique| cells(report, technique, metric)).collect();
        let (label, description) = (label(metric), escape(metric.description));
        format!("<tr><th scope=\"row\">{label} <small>{description}</small></th>{cells}</tr>\n")
    };
    metrics.iter().map(row).collect()
}

fn cells(report: &Report, technique: &str, metric: &Metric) -> String {
    let mean = format_value(metric, mean(report, technique, metric));
    format!(r#"<td class="n">{mean}</td><td class="n">{}</td>"#, worst_link(report, technique, metric))
}

/// Returns the worst value, with a link to its case if it deviates from the ideal.
fn worst_link(report: &Report, technique: &str, metric: &Metric) -> String {
    let Some((case, value)) = worst(report, technique, metric) else { return format_value(metric, None) };
    let shown = format_value(metric, Some(value));
    match report.cases.iter().position(|other| std::ptr::eq(other, case)) {
        Some(index) if deviation(metric, value) > 0.0 => {
            let (id, place) = (case_id(index), format!("{}, {}, {}", case.scene, case.light, case.view));
            format!("<a href=\"#{id}\">{shown} <small>{}</small></a>", escape(&place))
        }
        _ => shown,
    }
}
