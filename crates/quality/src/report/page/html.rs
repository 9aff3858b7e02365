//! What all parts of the page are written with.

use super::super::data::CaseReport;
use super::super::metric::Metric;

/// Text as it is safe between tags and in quoted attributes.
pub(super) fn escaped(text: &str) -> String {
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

/// A path with `/` between folders as a link to it. A colon is no scheme.
pub(super) fn link(path: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"/-._~".contains(&byte);
    let byte = |byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    path.bytes().map(byte).collect()
}

/// What a case's section is linked by.
pub(super) fn case_id(index: usize) -> String {
    format!("case-{}", index + 1)
}

/// A case's name, escaped.
pub(super) fn case_name(case: &CaseReport) -> String {
    let CaseReport { scene, light, view, technique, .. } = case;
    escaped(&format!("{scene}, {light}, {view}, {technique}"))
}

/// A metric's heading on one line, escaped.
pub(super) fn label(metric: &Metric) -> String {
    let [first, second] = metric.heading;
    match first.strip_suffix('-') {
        Some(first) => escaped(&format!("{first}{second}")),
        None => escaped(format!("{first} {second}").trim_end()),
    }
}
