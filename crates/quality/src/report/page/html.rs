//! Escaping and elements that all parts of the page use.

use super::super::data::CaseReport;
use super::super::metric::Metric;

/// Escapes text for use between tags and in quoted attributes.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            _ => out.push(c),
        }
    }
    out
}

/// Percent-encodes a path with `/` as separator, including colons, so that it cannot have a scheme.
pub(super) fn encode_path(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte);
    let byte = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    path.bytes().map(byte).collect()
}

/// Returns the id of the section of a case.
pub(super) fn case_id(index: usize) -> String {
    format!("case-{}", index + 1)
}

/// Returns the name of a case, escaped.
pub(super) fn case_name(case: &CaseReport) -> String {
    let CaseReport { scene, light, view, technique, .. } = case;
    escape(&format!("{scene}, {light}, {view}, {technique}"))
}

/// Returns the heading of a metric on one line, escaped.
pub(super) fn label(metric: &Metric) -> String {
    let [first, second] = metric.heading;
    match first.strip_suffix('-') {
        Some(first) => escape(&format!("{first}{second}")),
        None => escape(format!("{first} {second}").trim_end()),
    }
}
