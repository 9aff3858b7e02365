//! `cargo xtask test`: every check of the project, one step after the other.

use crate::child::{self, RuntimeDir};
use crate::machine::{self, Need};
use crate::report::Report;
use crate::steps;
use crate::tally::Tally;
use crate::web;
use std::path::PathBuf;
use std::process::ExitCode;

/// The work of a step.
enum Work {
    /// Makes sure that the machine has what tests need.
    Machine,
    /// Builds the page for browsers, which some tests open.
    Page,
    /// A cargo command and the variables that it adds to the environment.
    Check(&'static [&'static str], &'static [(&'static str, &'static str)]),
    /// A `cargo test` command, whose tests are counted.
    Tests(&'static [&'static str]),
}

const STEPS: [(&str, Work); 7] = [
    ("machine", Work::Machine),
    ("format", Work::Check(&["fmt", "--all", "--check"], &[])),
    ("lints", Work::Check(&["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"], &[])),
    ("documentation", Work::Check(&["doc", "--workspace", "--no-deps"], &[("RUSTDOCFLAGS", "-D warnings")])),
    ("page", Work::Page),
    ("tests", Work::Tests(&["test", "--workspace", "--no-fail-fast"])),
    (
        "core without a GPU library",
        // The tests of many random frames only use the compiler, which is the same as in the step before.
        Work::Tests(&[
            "test",
            "--package",
            "shadowgraph-core",
            "--no-default-features",
            "--no-fail-fast",
            "--",
            "--skip",
            "random_frames",
        ]),
    ),
];

pub(crate) fn run() -> ExitCode {
    let runtime = RuntimeDir::new();
    let mut report = Report::default();
    let mut page = None;
    for (number, (name, work)) in STEPS.iter().enumerate() {
        let what = match work {
            Work::Machine => "a software Vulkan driver, and the programs that tests start".to_owned(),
            Work::Page => "the page for browsers, built quickly".to_owned(),
            Work::Check(arguments, _) | Work::Tests(arguments) => format!("cargo {}", arguments.join(" ")),
        };
        let heading = format!("{}/{} {name}: {what}", number + 1, STEPS.len());
        report.steps.push(steps::run(name, &heading, || match work {
            Work::Machine => (machine::prepare(Need::Tests), Tally::default()),
            Work::Check(arguments, variables) => steps::cargo(arguments, variables),
            Work::Page => {
                let built = build_page();
                page = built.as_ref().ok().cloned().flatten();
                (built.map(drop), Tally::default())
            }
            Work::Tests(arguments) => {
                let mut command = child::cargo(arguments);
                command.envs(page.iter().map(|page| ("SHADOWGRAPH_WEB", page)));
                steps::tests(&mut command, &runtime)
            }
        }));
    }
    report.finish(allowed_skips())
}

/// Builds the page for browsers, and returns its directory; `None` where it cannot be built.
fn build_page() -> Result<Option<PathBuf>, String> {
    if let Err(reason) = web::toolchain() {
        println!("Tests of the page are skipped: {reason}");
        return Ok(None);
    }
    let directory = child::root().join("out/web-test");
    web::build(web::Kind::Test, &directory)?;
    Ok(Some(directory))
}

/// Returns the committed list of skips.
pub(crate) fn allowed_skips() -> Result<String, String> {
    let list = child::root().join("tests/skips.txt");
    std::fs::read_to_string(&list).map_err(|error| format!("{}: {error}", list.display()))
}
