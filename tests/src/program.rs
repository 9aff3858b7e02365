//! The built `shadowgraph` program.

use crate::repository;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::OnceLock;

/// The reason why the program could not be built.
#[derive(Clone, Debug)]
pub struct ProgramError(String);

impl std::fmt::Display for ProgramError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "the program could not be built: {}", self.0)
    }
}

impl std::error::Error for ProgramError {}

/// Returns the path of the program, which each test program builds once, or the one that the variable `SHADOWGRAPH_PROGRAM` names.
///
/// # Errors
/// When cargo cannot build it.
pub fn program() -> Result<&'static Path, ProgramError> {
    static PROGRAM: OnceLock<Result<PathBuf, ProgramError>> = OnceLock::new();
    let find = || std::env::var_os("SHADOWGRAPH_PROGRAM").map_or_else(build, |program| Ok(program.into()));
    PROGRAM.get_or_init(find).as_deref().map_err(Clone::clone)
}

fn build() -> Result<PathBuf, ProgramError> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    // Naming the whole workspace gives the features of `cargo test --workspace`, which has
    // built nearly everything already.
    command.args(["build", "--quiet", "--workspace", "--bin", "shadowgraph"]);
    command
        .arg("--message-format=json-render-diagnostics")
        .current_dir(repository())
        .stderr(Stdio::inherit());
    let output = command.output().map_err(|error| ProgramError(error.to_string()))?;
    if !output.status.success() {
        return Err(ProgramError(output.status.to_string()));
    }
    let messages = String::from_utf8_lossy(&output.stdout);
    let executable = messages.lines().find_map(|line| {
        let message: Value = serde_json::from_str(line).ok()?;
        (message["target"]["name"] == "shadowgraph")
            .then(|| message["executable"].as_str().map(PathBuf::from))?
    });
    executable.ok_or_else(|| ProgramError("cargo did not say where it is".to_owned()))
}

/// Returns whether a program of that name can be started.
pub fn on_path(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|dir| dir.join(program).is_file())
}
