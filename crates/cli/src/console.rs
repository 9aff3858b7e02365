//! Standard output and standard error, without a panic when nobody reads them.

use super::failure::Failure;
use std::io::{ErrorKind, Write};

/// Prints to standard output. A reader that has gone (`| head`) is no failure.
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

/// Tells what went wrong, in one line.
pub(crate) fn error(message: &str) {
    line("error", message);
}

/// Tells what is not as the user may expect, in one line.
pub(crate) fn warning(message: &str) {
    line("warning", message);
}

fn line(kind: &str, message: &str) {
    // Nobody may be left to read it.
    let _unread = writeln!(std::io::stderr(), "{kind}: {}", one_line(message));
}

/// Makes one line of any text: names in a file may hold line ends and terminal codes.
pub(crate) fn one_line(text: &str) -> String {
    let words = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let joined = words.collect::<Vec<_>>().join("; ").replace(":; ", ": ");
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
