//! The pixel tests, whose program lies next to this one.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::data::PixelTests;

/// Runs the tests on an adapter and reads their results.
pub(crate) fn run(adapter: &str) -> Result<PixelTests, String> {
    let here = std::env::current_exe().map_err(|error| error.to_string())?;
    let here = here.parent().unwrap_or(Path::new("."));
    let program = here.join("pixels");
    let output = Command::new(&program)
        .env("SHADOWGRAPH_REPOSITORY", here.join("files"))
        .env("SHADOWGRAPH_PROGRAM", here.join("shadowgraph"))
        .env("SHADOWGRAPH_ADAPTER", adapter)
        .env_remove("RUST_BACKTRACE")
        .arg("--show-output")
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| format!("cannot start {}: {error}", program.display()))?;
    let results = read(&String::from_utf8_lossy(&output.stdout));
    match results.passed + results.failed.len() {
        0 => Err(format!("{} ran no test ({})", program.display(), output.status)),
        _ => Ok(results),
    }
}

/// Reads the output of a test program.
fn read(output: &str) -> PixelTests {
    let mut results = PixelTests::default();
    let mut section = "";
    let mut skips = 0;
    for line in output.lines() {
        if let Some(name) = line.strip_prefix("test ").and_then(|line| line.strip_suffix(" ... FAILED")) {
            results.failed.push((name.to_owned(), String::new()));
        } else if line.starts_with("test ") && line.ends_with(" ... ok") {
            results.passed += 1;
        } else if let Some(name) = line.strip_prefix("---- ") {
            section = name.strip_suffix(" stdout ----").unwrap_or(name);
        } else if let Some(skip) = line.strip_prefix("SKIP ") {
            skips += 1;
            let skip = skip.to_owned();
            if !results.skipped.contains(&skip) {
                results.skipped.push(skip);
            }
        } else if let Some((_, reason)) = results.failed.iter_mut().find(|(name, _)| name == section) {
            // The first line after the one with the place is the message.
            if reason.is_empty() && !line.is_empty() && !line.starts_with("thread '") {
                line.chars().take(300).for_each(|letter| reason.push(letter));
            }
        }
    }
    results.passed = results.passed.saturating_sub(skips);
    results
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_a_test_program_are_read() {
        let output = "running 4 tests\ntest a::good ... ok\ntest bad ... FAILED\ntest none ... ok\n\nsuccesses:\n\n\
            ---- none stdout ----\nSKIP scenes: missing\n\nfailures:\n\n---- bad stdout ----\n\n\
            thread 'bad' (7) panicked at tests/a.rs:1:1:\nassertion failed: 1 > 2\nnote: run\n";
        let expected = PixelTests {
            passed: 1,
            failed: vec![("bad".into(), "assertion failed: 1 > 2".into())],
            skipped: vec!["scenes: missing".into()],
        };
        assert_eq!(read(output), expected);
    }
}
