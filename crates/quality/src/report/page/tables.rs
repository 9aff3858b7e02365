//! The tables of all cases, and of the mean and the worst case of each technique.

use super::super::data::{CaseReport, Report};
use super::super::metric::Metric;
use super::super::summary::{deviation, format_value, mean, worst};
use super::html::{case_id, case_name, escape, label};

/// Number of tints, up to that of the worst value of the column.
const TINTS: f64 = 5.0;

/// Returns the headings: four names and the metrics. A click sorts by a column.
pub(super) fn case_headings(metrics: &[&Metric]) -> String {
    let names = ["scene", "light", "view", "technique"]
        .map(|name| format!(r#"<th scope="col"><button type="button">{name}</button></th>"#));
    let numbers = metrics.iter().map(|metric| {
        let ([first, second], description) = (metric.heading.map(escape), escape(metric.description));
        let button = format!(r#"<button type="button">{first}<br>{second}</button>"#);
        format!(r#"<th scope="col" class="n" title="{description}">{button}</th>"#)
    });
    names.into_iter().chain(numbers).collect()
}

/// Returns a row for each case, with a link to its section.
pub(super) fn case_rows(report: &Report, metrics: &[&Metric]) -> String {
    let worst: Vec<_> = metrics.iter().map(|metric| worst_off(report, metric)).collect();
    let row = |(index, case): (usize, &CaseReport)| {
        let (id, name, scene) = (case_id(index), case_name(case), escape(&case.scene));
        let [light, view, technique] = [&case.light, &case.view, &case.technique].map(|name| escape(name));
        let numbers = metrics.iter().zip(&worst).map(|(metric, worst)| number(metric, *worst, case));
        format!(
            "<tr><th scope=\"row\"><a href=\"#{id}\" aria-label=\"{name}\">{scene}</a></th>\
             <td>{light}</td><td>{view}</td><td>{technique}</td>{}</tr>\n",
            numbers.collect::<String>()
        )
    };
    report.cases.iter().enumerate().map(row).collect()
}

/// Returns the deviation of the worst case, `None` if all are equal.
fn worst_off(report: &Report, metric: &Metric) -> Option<f64> {
    let offs =
        || report.cases.iter().filter_map(|case| (metric.value)(case)).map(|value| deviation(metric, value));
    let least = offs().min_by(f64::total_cmp);
    offs().max_by(f64::total_cmp).filter(|worst| Some(*worst) != least)
}

fn number(metric: &Metric, worst_off: Option<f64>, case: &CaseReport) -> String {
    let value = (metric.value)(case);
    let part = value.zip(worst_off).map_or(0.0, |(value, worst)| deviation(metric, value) / worst);
    let tint = (TINTS * part).round();
    let tint = if tint >= 1.0 { format!(" t{tint}") } else { String::new() };
    format!(r#"<td class="n{tint}">{}</td>"#, format_value(metric, value))
}

/// Headings of one technique's columns.
pub(super) const SUMMARY_COLUMNS: &str =
    r#"<th scope="col" class="n">mean</th><th scope="col" class="n">worst</th>"#;

/// Returns the headings above [`SUMMARY_COLUMNS`], the names of techniques.
pub(super) fn summary_names(techniques: &[&str]) -> String {
    let name = |name: &&str| format!(r#"<th scope="colgroup" colspan="2">{}</th>"#, escape(name));
    techniques.iter().map(name).collect()
}

/// Returns a row for each metric.
pub(super) fn summary_rows(report: &Report, techniques: &[&str], metrics: &[&Metric]) -> String {
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
