//! All cases in one table.

use super::super::data::{CaseReport, Report};
use super::super::metric::Metric;
use super::super::summary::{off, shown};
use super::html::{case_id, case_name, escaped};

/// How many tints there are, from barely off to the column's worst.
const TINTS: f64 = 5.0;

/// The headings: four names and the metrics. A click sorts by them.
pub(super) fn headings(metrics: &[&Metric]) -> String {
    let names = ["scene", "light", "view", "technique"]
        .map(|name| format!(r#"<th scope="col"><button type="button">{name}</button></th>"#));
    let numbers = metrics.iter().map(|metric| {
        let ([first, second], about) = (metric.heading.map(escaped), escaped(metric.about));
        let button = format!(r#"<button type="button">{first}<br>{second}</button>"#);
        format!(r#"<th scope="col" class="n" title="{about}">{button}</th>"#)
    });
    names.into_iter().chain(numbers).collect()
}

/// A row for each case, which links to the case's section.
pub(super) fn rows(report: &Report, metrics: &[&Metric]) -> String {
    let worst: Vec<_> = metrics.iter().map(|metric| worst_off(report, metric)).collect();
    let row = |(index, case): (usize, &CaseReport)| {
        let (id, name, scene) = (case_id(index), case_name(case), escaped(&case.scene));
        let [light, view, technique] = [&case.light, &case.view, &case.technique].map(|name| escaped(name));
        let numbers = metrics.iter().zip(&worst).map(|(metric, worst)| number(metric, *worst, case));
        format!(
            "<tr><th scope=\"row\"><a href=\"#{id}\" aria-label=\"{name}\">{scene}</a></th>\
             <td>{light}</td><td>{view}</td><td>{technique}</td>{}</tr>\n",
            numbers.collect::<String>()
        )
    };
    report.cases.iter().enumerate().map(row).collect()
}

/// How far off the worst case is, `None` where all are the same.
fn worst_off(report: &Report, metric: &Metric) -> Option<f64> {
    let offs = || report.cases.iter().filter_map(|case| (metric.of)(case)).map(|value| off(metric, value));
    let least = offs().min_by(f64::total_cmp);
    offs().max_by(f64::total_cmp).filter(|worst| Some(*worst) != least)
}

fn number(metric: &Metric, worst_off: Option<f64>, case: &CaseReport) -> String {
    let value = (metric.of)(case);
    let part = value.zip(worst_off).map_or(0.0, |(value, worst)| off(metric, value) / worst);
    let tint = (TINTS * part).round();
    let tint = if tint >= 1.0 { format!(" t{tint}") } else { String::new() };
    format!(r#"<td class="n{tint}">{}</td>"#, shown(metric, value))
}
