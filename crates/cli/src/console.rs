//! Standard output and standard error, without a panic when nobody reads them.

use super::failure::Failure;
use std::io::{ErrorKind, Write};

/// Prints to standard output. A closed pipe (`| head`) is not an error.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure {
            code: Failure::INPUT,
            message: format!("standard output cannot be written: {error}"),
        }),
        _ => Ok(()),
    }
}

/// Prints an error in one line.
pub(crate) fn error(message: &str) {
    line("error", message);
}

/// Prints a warning in one line.
pub(crate) fn warning(message: &str) {
    line("warning", message);
}

fn line(kind: &str, message: &str) {
    // Standard error may be closed.
    let _unread = writeln!(std::io::stderr(), "{kind}: {}", one_line(message));
}

/// Converts text to one line: names in a file may contain line breaks and terminal codes.
pub(crate) fn one_line(text: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let joined = lines.collect::<Vec<_>>().join("; ").replace(":; ", ": ");
    joined.chars().map(|c| if c.is_control() { '\u{fffd}' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_of_several_lines_becomes_one() {
        assert_eq!(one_line("a\n  b\r\n\nc:\n  d"), "a; b; c: d");
    }

    #[test]
    fn terminal_codes_do_not_reach_the_terminal() {
        assert_eq!(one_line("bad \u{1b}[31mname"), "bad \u{fffd}[31mname");
    }
}
