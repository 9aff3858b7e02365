//! A report as one page: numbers to sort and filter, and images to flip through.

mod case;
mod html;
mod tables;
#[cfg(test)]
mod tests;

use html::escape;

use super::data::Report;
use super::summary::{metrics_with_values, techniques};

/// Returns a report as an HTML page, which refers only to the image files of the report, by paths relative to the
/// page with `/` as separator. The same report gives the same page.
#[must_use]
pub fn page(report: &Report) -> String {
    let metrics = metrics_with_values(report);
    let techniques = techniques(report);
    let [width_px, height_px] = report.size_px;
    let settings = serde_json::to_string_pretty(&report.settings).unwrap_or_else(|error| error.to_string());
    format!(
        include_str!("page.html"),
        style = include_str!("page.css"),
        cases = count_label(report.cases.len(), "case"),
        techniques = count_label(techniques.len(), "technique"),
        width_px = width_px,
        height_px = height_px,
        adapter = escape(&report.adapter),
        settings = escape(&settings),
        summary_groups = "<colgroup span=\"2\"></colgroup>".repeat(techniques.len()),
        summary_names = tables::summary_names(&techniques),
        summary_columns = tables::SUMMARY_COLUMNS.repeat(techniques.len()),
        summary_rows = tables::summary_rows(report, &techniques, &metrics),
        case_headings = tables::case_headings(&metrics),
        case_rows = tables::case_rows(report, &metrics),
        sections = case::sections(report, &metrics),
        script = include_str!("page.js"),
    )
}

fn count_label(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}
