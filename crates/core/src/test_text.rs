//! Texts of errors in tests.

/// Returns an error's text without the places in which passes are declared.
pub(crate) fn without_places(error: &crate::Error) -> String {
    let text = error.to_string();
    let mut parts = text.split(" (crates");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| text + part.split_once(')').map_or("", |(_, rest)| rest))
}
