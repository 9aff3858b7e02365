//! The section of each case: its images and all its numbers.

use super::super::data::{CaseReport, Flicker, Motion, Report};
use super::super::metric::Metric;
use super::super::summary::format_value;
use super::html::{case_id, case_name, encode_path, escape, label};

pub(super) fn sections(report: &Report, metrics: &[&Metric]) -> String {
    let section = |(index, case)| section(&case_id(index), case, &images(report.size_px, case), metrics);
    report.cases.iter().enumerate().map(section).collect()
}

fn section(id: &str, case: &CaseReport, images: &str, metrics: &[&Metric]) -> String {
    let numbers = metrics.iter().map(|metric| {
        let (label, description) = (label(metric), escape(metric.description));
        let value = format_value(metric, (metric.value)(case));
        format!("<div title=\"{description}\"><dt>{label}</dt><dd>{value}</dd></div>\n")
    });
    format!(
        "<section class=\"case\" id=\"{id}\" aria-labelledby=\"{id}-name\">\n<h3 id=\"{id}-name\">{}</h3>\n\
         {images}<dl>\n{}</dl>\n<div class=\"tables\">\n{}{}</div>\n\
         <p><a href=\"#cases\">Back to all cases</a></p>\n</section>\n",
        case_name(case),
        numbers.collect::<String>(),
        acne(case),
        flicker(&case.flicker),
    )
}

/// Returns the four images; the script shows the linked files enlarged.
fn images([width_px, height_px]: [u32; 2], case: &CaseReport) -> String {
    let Some(files) = &case.images else { return String::new() };
    let visibility = format!("Visibility of {}", case.technique);
    let images = [
        ("Rendered", &files.color),
        ("Reference", &files.truth),
        (&visibility, &files.visibility),
        ("Difference", &files.difference),
    ];
    let images = images.map(|(caption, file)| {
        let (caption, name, file) = (escape(caption), case_name(case), encode_path(file));
        format!(
            "<figure><a href=\"{file}\"><img src=\"{file}\" alt=\"{caption}: {name}\" width=\"{width_px}\" \
             height=\"{height_px}\" loading=\"lazy\"></a><figcaption>{caption}</figcaption></figure>\n"
        )
    });
    format!("<div class=\"images\">\n{}</div>\n", images.concat())
}

fn acne(case: &CaseReport) -> String {
    let bins = &case.errors.misclassified.outside.acne_by_n_dot_l;
    let ends = bins.iter().skip(1).map(|bin| bin.n_dot_l_above).chain([1.0]);
    let rows = bins.iter().zip(ends).map(|(bin, end)| {
        let percent = format!("{:.3}", bin.acne_percent);
        row(
            &format!("{} to {end}", bin.n_dot_l_above),
            &[bin.receivers.to_string(), bin.acne.to_string(), percent],
        )
    });
    table("Acne by N·L, outside the band", ["N·L", "receivers", "acne", "%"], rows)
}

fn flicker(flickers: &[Flicker]) -> String {
    if flickers.is_empty() {
        return String::new();
    }
    let rows = flickers.iter().map(|Flicker { motion, far_out, change }| {
        let motion = match motion {
            Motion::Translate => "translate",
            Motion::Rotate => "rotate",
            Motion::Zoom => "zoom",
        };
        let place = if *far_out { "10 km out" } else { "at the origin" };
        let [mean, p99] = [change.mean, change.p99].map(|value| format!("{value:.4}"));
        row(&format!("{motion}, {place}"), &[change.count.to_string(), mean, p99])
    });
    table("Flicker while the camera moves", ["motion", "points", "mean", "p99"], rows)
}

fn table(caption: &str, [name, numbers @ ..]: [&str; 4], rows: impl Iterator<Item = String>) -> String {
    let numbers = numbers.map(|heading| format!(r#"<th scope="col" class="n">{heading}</th>"#)).concat();
    format!(
        "<table>\n<caption>{caption}</caption>\n<thead><tr><th scope=\"col\">{name}</th>{numbers}</tr></thead>\n\
         <tbody>\n{}</tbody>\n</table>\n",
        rows.collect::<String>()
    )
}

fn row(name: &str, numbers: &[String; 3]) -> String {
    let cells: String = numbers.iter().map(|number| format!(r#"<td class="n">{number}</td>"#)).collect();
    format!("<tr><th scope=\"row\">{name}</th>{cells}</tr>\n")
}
