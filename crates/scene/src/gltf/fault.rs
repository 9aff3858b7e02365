//! What is wrong with a file and where, before the file's name is known.

use std::fmt::Display;

/// The longest text that is taken over from a file into a message, characters.
const MAX_TEXT: usize = 300;
/// The longest name that is taken over from a file, characters.
const MAX_NAME: usize = 120;

/// Something wrong at a place of the file.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) place: String,
    pub(super) reason: String,
}

/// Makes a fault; both texts become one line.
pub(super) fn fault(place: impl Display, reason: impl Display) -> Fault {
    Fault { place: one_line(&place.to_string(), MAX_TEXT), reason: one_line(&reason.to_string(), MAX_TEXT) }
}

/// Gives a reason the place where it holds.
pub(super) trait At<T> {
    /// Turns the error into a [`Fault`] at the place.
    fn at<D: Display>(self, place: impl FnOnce() -> D) -> Result<T, Fault>;
}

impl<T, E: Display> At<T> for Result<T, E> {
    fn at<D: Display>(self, place: impl FnOnce() -> D) -> Result<T, Fault> {
        self.map_err(|reason| fault(place(), reason))
    }
}

/// Returns a name from the file, free of control characters and not longer than is useful.
pub(super) fn clean_name(name: Option<&str>) -> String {
    one_line(name.unwrap_or_default(), MAX_NAME)
}

/// Describes an object of the file by its kind, index and name: `mesh 3 "Roof"`.
pub(super) fn place(kind: &str, index: usize, name: Option<&str>) -> String {
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
    fn texts_from_the_file_stay_on_one_line_and_short() {
        let fault = fault("mesh 0", "a\nb\r\nc\u{1b}[31m");
        assert_eq!(fault.reason, "a b  c [31m");
        assert_eq!(clean_name(Some(&"x".repeat(1 << 20))).chars().count(), MAX_NAME + 1);
        assert_eq!(place("node", 2, Some("a\"b")), "node 2 \"a\\\"b\"");
    }
}
