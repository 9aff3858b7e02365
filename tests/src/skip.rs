//! Skips that the test run reports.

use std::io::Write;

/// Records that a test cannot run here; the test returns right after.
///
/// The line `SKIP <id>: <reason>` goes to standard output and to the file that `SHADOWGRAPH_SKIP_LOG`
/// names; `cargo xtask test` reads it and counts the test as skipped. `id` must be in `tests/skips.txt`.
#[allow(clippy::print_stdout, reason = "the person who runs the test reads the line")]
pub fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {}\n", reason.replace('\n', " "));
    print!("{line}");
    let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") else { return };
    let file = std::fs::OpenOptions::new().append(true).create(true).open(&log);
    // One write per line, so that lines of other threads and programs are not mixed in.
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    if let Err(error) = written {
        println!("cannot write the skip to {}: {error}", log.to_string_lossy());
    }
}
