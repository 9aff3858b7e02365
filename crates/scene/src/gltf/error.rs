//! Errors of an import: what is wrong and where in the file, before the file's name is added.

use std::fmt::Display;

/// The longest text that a message quotes from a file, characters.
const MAX_TEXT: usize = 300;
/// The longest name that is kept from a file, characters.
const MAX_NAME: usize = 120;

/// Something that is wrong at a location in the file.
#[derive(Debug)]
pub(super) struct ImportError {
    pub(super) location: String,
    pub(super) reason: String,
}

impl ImportError {
    /// Creates an error; both texts become one line.
    pub(super) fn new(location: impl Display, reason: impl Display) -> Self {
        Self {
            location: one_line(&location.to_string(), MAX_TEXT),
            reason: one_line(&reason.to_string(), MAX_TEXT),
        }
    }
}

/// Adds a location in the file to an error.
pub(super) trait WithLocation<T> {
    /// Turns the error into an [`ImportError`] at the location.
    fn with_location<D: Display>(self, location: impl FnOnce() -> D) -> Result<T, ImportError>;
}

impl<T, E: Display> WithLocation<T> for Result<T, E> {
    fn with_location<D: Display>(self, location: impl FnOnce() -> D) -> Result<T, ImportError> {
        self.map_err(|reason| ImportError::new(location(), reason))
    }
}

/// Returns a name from the file without control characters and of limited length.
pub(super) fn clean_name(name: Option<&str>) -> String {
    one_line(name.unwrap_or_default(), MAX_NAME)
}

/// Describes an object of the file by its kind, index and name: `mesh 3 "Roof"`.
pub(super) fn describe(kind: &str, index: usize, name: Option<&str>) -> String {
    match clean_name(name).as_str() {
        "" => format!("{kind} {index}"),
        name => format!("{kind} {index} {name:?}"),
    }
}

fn one_line(text: &str, limit: usize) -> String {
    let plain = |c: char| if c.is_control() || matches!(c, '\u{2028}' | '\u{2029}') { ' ' } else { c };
    let mut line: String = text.chars().take(limit).map(plain).collect();
    if text.chars().nth(limit).is_some() {
        line.push('…');
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_from_the_file_are_one_line_of_limited_length() {
        let error = ImportError::new("mesh 0", "a\nb\r\nc\u{1b}[31m");
        assert_eq!(error.reason, "a b  c [31m");
        assert_eq!(clean_name(Some(&"x".repeat(1 << 20))).chars().count(), MAX_NAME + 1);
        assert_eq!(describe("node", 2, Some("a\"b")), "node 2 \"a\\\"b\"");
    }
}
