//! The steps that `test` and `check` share: a command that must succeed, and test programs whose tests are counted.

use crate::child::{self, RuntimeDir};
use crate::report::Step;
use crate::tally::Tally;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

/// The result of a step and the tests that it counted.
pub(crate) type Outcome = (Result<(), String>, Tally);

/// Runs a step under a heading and takes its time.
pub(crate) fn run(name: &'static str, heading: &str, work: impl FnOnce() -> Outcome) -> Step {
    println!("\n=== {heading}");
    let start = Instant::now();
    let (result, tally) = work();
    if let Err(error) = &result {
        println!("\nFAILED {name}: {error}");
    }
    Step { name, seconds: start.elapsed().as_secs_f64(), error: result.err(), tally }
}

/// Runs a cargo command that must succeed.
pub(crate) fn cargo(arguments: &[&str], variables: &[(&str, &str)]) -> Outcome {
    let mut command = child::cargo(arguments);
    command.envs(variables.iter().copied());
    let result = child::stream(&mut command).and_then(|status| match status.success() {
        true => Ok(()),
        false => Err(format!("cargo {} ({status})", arguments[0])),
    });
    (result, Tally::default())
}

/// Runs a command that runs tests, shows its output and counts the tests and their skips.
pub(crate) fn tests(command: &mut Command, runtime: &RuntimeDir) -> Outcome {
    let mut tally = Tally::default();
    let log = SkipLog::new();
    command.env("SHADOWGRAPH_SKIP_LOG", &log.0);
    let result = child::stream_lines(runtime.apply(command), |line| tally.read_line(line));
    tally.read_log(&log.read());
    let result = result.and_then(|status| match status.success() {
        true => Ok(()),
        false if tally.failed > 0 => Err(format!("{} tests failed", tally.failed)),
        false => Err(format!("the tests ended with {status}")),
    });
    (result, tally)
}

/// The file to which tests append their skips: standard output is captured and shared by threads.
struct SkipLog(PathBuf);

impl SkipLog {
    fn new() -> SkipLog {
        let log = SkipLog(std::env::temp_dir().join(format!("shadowgraph-skips-{}.log", std::process::id())));
        log.remove();
        log
    }

    fn read(&self) -> String {
        // No file means that no test skipped.
        std::fs::read_to_string(&self.0).unwrap_or_default()
    }

    fn remove(&self) {
        let _absent = std::fs::remove_file(&self.0);
    }
}

impl Drop for SkipLog {
    fn drop(&mut self) {
        self.remove();
    }
}
