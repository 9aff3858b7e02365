//! `cargo xtask test`: every check of the project, one step after the other.

use crate::child::{self, RuntimeFolder};
use crate::machine::{self, Need};
use crate::report::{Report, Step};
use crate::tally::Tally;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

/// What a step runs.
enum Work {
    /// Makes sure that the machine has what tests need.
    Machine,
    /// A cargo command and what it adds to the environment.
    Check(&'static [&'static str], &'static [(&'static str, &'static str)]),
    /// A `cargo test` command, whose tests are counted.
    Tests(&'static [&'static str]),
}

/// Lints and documentation only look at dependencies, and that takes half as long unoptimized.
const UNOPTIMIZED: &str = r#"--config=profile.dev.package."*".opt-level=0"#;

const STEPS: [(&str, Work); 6] = [
    ("machine", Work::Machine),
    ("format", Work::Check(&["fmt", "--all", "--check"], &[])),
    (
        "lints",
        Work::Check(&["clippy", UNOPTIMIZED, "--workspace", "--all-targets", "--", "-D", "warnings"], &[]),
    ),
    (
        "documentation",
        Work::Check(&["doc", UNOPTIMIZED, "--workspace", "--no-deps"], &[("RUSTDOCFLAGS", "-D warnings")]),
    ),
    ("tests", Work::Tests(&["test", "--workspace", "--no-fail-fast"])),
    (
        "core without a GPU library",
        Work::Tests(&["test", "--package", "shadowgraph-core", "--no-default-features", "--no-fail-fast"]),
    ),
];

pub(crate) fn run() -> ExitCode {
    let runtime = RuntimeFolder::new();
    let mut report = Report::default();
    for (number, (name, work)) in STEPS.iter().enumerate() {
        heading(number + 1, name, work);
        let start = Instant::now();
        let (result, tally) = match work {
            Work::Machine => (machine::prepare(Need::Tests), Tally::default()),
            Work::Check(arguments, variables) => (check(arguments, variables), Tally::default()),
            Work::Tests(arguments) => tests(arguments, &runtime),
        };
        if let Err(error) = &result {
            println!("\nFAILED {name}: {error}");
        }
        report.steps.push(Step { name, seconds: start.elapsed().as_secs_f64(), error: result.err(), tally });
    }
    let list = child::root().join("tests/skips.txt");
    report.finish(std::fs::read_to_string(&list).map_err(|error| format!("{}: {error}", list.display())))
}

fn heading(number: usize, name: &str, work: &Work) {
    let what = match work {
        Work::Machine => "a software Vulkan driver, and the programs that tests start".to_owned(),
        Work::Check(arguments, _) | Work::Tests(arguments) => format!("cargo {}", arguments.join(" ")),
    };
    println!("\n=== {number}/{} {name}: {what}", STEPS.len());
}

fn check(arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    let mut command = child::cargo(arguments);
    command.envs(variables.iter().copied());
    let status = child::stream(&mut command)?;
    if status.success() { Ok(()) } else { Err(format!("cargo {} ({status})", arguments[0])) }
}

fn tests(arguments: &[&str], runtime: &RuntimeFolder) -> (Result<(), String>, Tally) {
    let mut tally = Tally::default();
    let log = SkipLog::new();
    let mut command = child::cargo(arguments);
    command.env("SHADOWGRAPH_SKIP_LOG", &log.0);
    let result = child::stream_lines(runtime.apply(&mut command), |line| tally.read_line(line));
    tally.read_log(&log.read());
    let result = result.and_then(|status| match status.success() {
        true => Ok(()),
        false if tally.failed > 0 => Err(format!("{} tests failed", tally.failed)),
        false => Err(format!("cargo test ({status})")),
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
