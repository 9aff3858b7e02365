//! `cargo xtask check`: format, lints, and the tests without a GPU of the packages that changed and of those that depend on them.
//!
//! Every cargo command names the whole workspace, so that features, and with them what is built, are those of `cargo xtask test`;
//! cargo itself leaves out the packages that are unaffected.

use crate::child::{self, RuntimeDir};
use crate::members::{self, Member};
use crate::report::Report;
use crate::steps::{self, Outcome};
use crate::suite;
use crate::tally::Tally;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode, Stdio};

/// Test programs that draw on a device or start programs: they take minutes on a software driver.
const WITH_A_GPU: [&str; 3] = ["pixels", "programs", "soak"];

pub(crate) fn run() -> ExitCode {
    match affected() {
        Ok(members) if members.is_empty() => {
            println!("Nothing has changed since the last commit and the main branch.");
            ExitCode::SUCCESS
        }
        Ok(members) => check(&members),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns the packages to check.
fn affected() -> Result<Vec<Member>, String> {
    let members = members::read()?;
    let changed = members::changed(&members, &changed_files()?);
    let dependents = members::dependents(&members, &changed);
    let list = |names: &BTreeSet<String>| names.iter().cloned().collect::<Vec<_>>().join(", ");
    if !changed.is_empty() {
        println!("Changed: {}", list(&changed));
    }
    if !dependents.is_empty() {
        println!("Depending on them: {}", list(&dependents));
    }
    let is_affected = |member: &Member| changed.contains(&member.name) || dependents.contains(&member.name);
    Ok(members.into_iter().filter(is_affected).collect())
}

/// Returns the files that differ from the last commit or from where the branch left `origin/main`, new files included.
fn changed_files() -> Result<Vec<PathBuf>, String> {
    let git = |arguments: &[&str]| child::stdout_of(child::command("git").args(arguments));
    let base = git(&["merge-base", "HEAD", "origin/main"]).unwrap_or_default();
    let base = if base.trim().is_empty() { "HEAD" } else { base.trim() };
    let tracked = git(&["diff", "--name-only", "--no-renames", "-z", base])?;
    let new = git(&["ls-files", "--others", "--exclude-standard", "-z"])?;
    let names = tracked.split('\0').chain(new.split('\0'));
    Ok(names.filter(|name| !name.is_empty()).map(PathBuf::from).collect())
}

fn check(members: &[Member]) -> ExitCode {
    let runtime = RuntimeDir::new();
    let lints = ["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"];
    let steps = vec![
        steps::run("format", "1/3 format: cargo fmt --all --check", || {
            steps::cargo(&["fmt", "--all", "--check"], &[])
        }),
        steps::run("lints", &format!("2/3 lints: cargo {}", lints.join(" ")), || steps::cargo(&lints, &[])),
        steps::run("tests", "3/3 tests without a GPU", || tests(members, &runtime)),
    ];
    let code = Report { steps }.finish(suite::allowed_skips());
    println!(
        "Left out, and part of `cargo xtask test`: documentation, doctests, examples, tests on a device ({})",
        WITH_A_GPU.join(", ")
    );
    code
}

/// Builds the test programs and runs those of the affected packages, one after the other.
fn tests(members: &[Member], runtime: &RuntimeDir) -> Outcome {
    let mut total = Tally::default();
    let mut failed = Vec::new();
    let programs = match build(members) {
        Ok(programs) => programs,
        Err(error) => return (Err(error), total),
    };
    for program in programs {
        let mut command = Command::new(&program.file);
        command.current_dir(&program.dir).env("CARGO_MANIFEST_DIR", &program.dir);
        // The loader of Vulkan finds no driver in a file that does not exist: tests that need a device skip.
        command.env("VK_DRIVER_FILES", "/nonexistent").env("VK_ICD_FILENAMES", "/nonexistent");
        println!("\n{}", program.file.display());
        let (result, tally) = steps::tests(&mut command, runtime);
        total.add(&tally);
        failed.extend(result.err().map(|error| format!("{}: {error}", program.file.display())));
    }
    (if failed.is_empty() { Ok(()) } else { Err(failed.join("; ")) }, total)
}

/// A built test program, and the directory of its package.
#[derive(Debug, PartialEq, Eq)]
struct Program {
    file: PathBuf,
    dir: PathBuf,
}

fn build(members: &[Member]) -> Result<Vec<Program>, String> {
    let mut command = child::cargo(&["test", "--workspace", "--no-run", "--quiet", "--lib"]);
    command.arg("--message-format=json-render-diagnostics").stderr(Stdio::inherit());
    for member in members {
        for name in integration_tests(&child::root().join(&member.dir)) {
            command.args(["--test", &name]);
        }
        if member.name == "xtask" {
            command.args(["--bin", "xtask"]);
        }
    }
    let messages = child::stdout_of(&mut command)?;
    let dirs: Vec<PathBuf> = members.iter().map(|member| child::root().join(&member.dir)).collect();
    Ok(messages.lines().filter_map(program).filter(|program| dirs.contains(&program.dir)).collect())
}

/// Returns the names of a package's test programs, without those that need a device.
fn integration_tests(dir: &Path) -> Vec<String> {
    let entries =
        std::fs::read_dir(dir.join("tests")).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_test =
        |path: &PathBuf| path.extension().is_some_and(|is| is == "rs") || path.join("main.rs").is_file();
    let names = entries.filter(is_test).filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned()));
    names.filter(|name| !WITH_A_GPU.contains(&name.as_str())).collect()
}

/// Reads one of cargo's messages: `None` if it is not about a test program.
fn program(message: &str) -> Option<Program> {
    // The profile says whether it was built as a test; the target has a field of that name, too.
    let (_, profile) = message.split_once(r#""profile":{"#)?;
    let is_test = profile.split_once('}')?.0.contains(r#""test":true"#);
    let value = |key: &str| {
        let (_, rest) = message.split_once(&format!("\"{key}\":\""))?;
        Some(PathBuf::from(rest.split_once('"')?.0.replace(r"\\", r"\")))
    };
    let dir = value("manifest_path").filter(|_| is_test)?.parent()?.to_owned();
    Some(Program { file: value("executable")?, dir })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_messages_about_test_programs_name_a_program() {
        let message = |test: bool, executable: &str| {
            format!(
                r#"{{"reason":"compiler-artifact","manifest_path":"/r/a/Cargo.toml","target":{{"name":"a","test":true}},"profile":{{"debuginfo":0,"test":{test}}},"executable":{executable}}}"#
            )
        };
        let expected = Program { file: "/t/a-1".into(), dir: "/r/a".into() };
        assert_eq!(program(&message(true, "\"/t/a-1\"")), Some(expected));
        assert_eq!(program(&message(false, "\"/t/a\"")), None);
        assert_eq!(program(&message(true, "null")), None);
        assert_eq!(program(r#"{"reason":"build-finished","success":true}"#), None);
    }
}
