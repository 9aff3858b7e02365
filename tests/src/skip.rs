//! Skips that are seen.

use std::io::Write;

/// Records that a test cannot run here; the test returns right after.
///
/// The line `SKIP <id>: <reason>` goes to standard output and to the file that `SHADOWGRAPH_SKIP_LOG`
/// names, where `cargo xtask test` counts it as skipped. `id` is to be in `tests/skips.txt`.
#[allow(clippy::print_stdout, reason = "the line is for whoever runs the test")]
pub fn skip(id: &str, reason: &str) {
    let line = format!("SKIP {id}: {}\n", reason.replace('\n', " "));
    print!("{line}");
    let Some(log) = std::env::var_os("SHADOWGRAPH_SKIP_LOG") else { return };
    let file = std::fs::OpenOptions::new().append(true).create(true).open(&log);
    // One write per line, so that tests in other threads and programs cannot come between.
    let written = file.and_then(|mut file| file.write_all(line.as_bytes()));
    if let Err(error) = written {
        println!("the skip could not be recorded in {}: {error}", log.to_string_lossy());
    }
}
