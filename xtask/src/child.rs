//! Child processes: cargo and other programs, started in the repository's root.

use std::ffi::OsStr;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

/// Returns the repository's root: the directory above this crate, as cargo names it when it runs this program. Where several
/// checkouts share a target directory, this program may have been built in another one.
pub(crate) fn root() -> PathBuf {
    let here = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    here.parent().unwrap_or(&here).to_path_buf()
}

/// Returns a cargo command in the repository's root, of the cargo that runs this program.
pub(crate) fn cargo(arguments: &[&str]) -> Command {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = command(cargo);
    command.args(arguments);
    command
}

/// Returns a command in the repository's root.
pub(crate) fn command(program: impl AsRef<OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// Runs a command to its end; it writes to the terminal.
///
/// # Errors
/// One line when it could not start.
pub(crate) fn stream(command: &mut Command) -> Result<ExitStatus, String> {
    command.status().map_err(|error| start_error(command, &error))
}

/// Runs a command to its end, prints each line of its standard output and passes it to `line`.
///
/// # Errors
/// One line when it could not start or its output could not be read.
pub(crate) fn stream_lines(command: &mut Command, mut line: impl FnMut(&str)) -> Result<ExitStatus, String> {
    let mut child = command.stdout(Stdio::piped()).spawn().map_err(|error| start_error(command, &error))?;
    if let Some(output) = child.stdout.take() {
        let mut output = BufReader::new(output);
        let mut bytes = Vec::new();
        while output
            .read_until(b'\n', &mut bytes)
            .map_err(|error| format!("cannot read its output: {error}"))?
            > 0
        {
            // A closed terminal must not end the run before its result is known.
            let _closed = std::io::stdout().write_all(&bytes);
            line(String::from_utf8_lossy(&bytes).trim_end());
            bytes.clear();
        }
    }
    child.wait().map_err(|error| format!("cannot wait for it: {error}"))
}

/// Returns whether a command succeeds, without showing its output.
pub(crate) fn succeeds(program: &str, arguments: &[&str]) -> bool {
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    command.status().is_ok_and(|status| status.success())
}

/// Returns what a command prints to standard output; empty if it cannot start.
pub(crate) fn output_of(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).stdin(Stdio::null()).output();
    output.map(|output| String::from_utf8_lossy(&output.stdout).into_owned()).unwrap_or_default()
}

/// Returns what a command that succeeds prints to standard output.
///
/// # Errors
/// One line when it could not start or failed.
pub(crate) fn stdout_of(command: &mut Command) -> Result<String, String> {
    let output = command.output().map_err(|error| start_error(command, &error))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    let program = command.get_program().to_string_lossy().into_owned();
    Err(format!("`{program}` failed ({}): {}", output.status, errors.trim()))
}

/// Returns what a build prints to standard output; its errors and progress go to the terminal.
///
/// # Errors
/// One line when it could not start or failed.
pub(crate) fn stdout_of_build(command: &mut Command) -> Result<String, String> {
    let output = command.stderr(Stdio::inherit()).output().map_err(|error| start_error(command, &error))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => Err(format!("the build failed ({})", output.status)),
    }
}

/// Returns whether a program of that name can be started.
pub(crate) fn on_path(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|dir| dir.join(program).is_file())
}

/// Returns whether programs find a shared library of that name (Linux).
pub(crate) fn has_library(name: &str) -> bool {
    let cached = |ldconfig: &str| output_of(ldconfig, &["-p"]).contains(name);
    if cached("ldconfig") || cached("/sbin/ldconfig") {
        return true;
    }
    let listed = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let mut dirs: Vec<PathBuf> = std::env::split_paths(&listed).collect();
    let triplet = format!("{}-linux-gnu", std::env::consts::ARCH);
    for base in ["/lib", "/usr/lib", "/lib64", "/usr/lib64", "/usr/local/lib", "/run/opengl-driver/lib"] {
        dirs.extend([PathBuf::from(base), Path::new(base).join(&triplet)]);
    }
    dirs.iter().any(|dir| dir.join(name).exists())
}

fn start_error(command: &Command, error: &std::io::Error) -> String {
    format!("cannot start `{}`: {error}", command.get_program().to_string_lossy())
}

/// A private directory for the sockets of child processes where the session has none: without one, graphics
/// libraries print warnings. Removed when dropped.
pub(crate) struct RuntimeDir(Option<PathBuf>);

impl RuntimeDir {
    /// Creates the directory if `XDG_RUNTIME_DIR` is unset on a system that uses it.
    pub(crate) fn new() -> RuntimeDir {
        if !cfg!(target_os = "linux") || std::env::var_os("XDG_RUNTIME_DIR").is_some() {
            return RuntimeDir(None);
        }
        let path = std::env::temp_dir().join(format!("shadowgraph-runtime-{}", std::process::id()));
        RuntimeDir(create_private(&path).then_some(path))
    }

    /// Sets the variable for a child process.
    pub(crate) fn apply<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        if let Some(path) = &self.0 {
            command.env("XDG_RUNTIME_DIR", path);
        }
        command
    }
}

impl Drop for RuntimeDir {
    fn drop(&mut self) {
        if let Some(path) = &self.0 {
            // A directory that stays among the temporary files does no harm.
            let _left = std::fs::remove_dir_all(path);
        }
    }
}

#[cfg(unix)]
fn create_private(path: &Path) -> bool {
    use std::os::unix::fs::DirBuilderExt;
    std::fs::DirBuilder::new().mode(0o700).create(path).is_ok()
}

#[cfg(not(unix))]
fn create_private(path: &Path) -> bool {
    std::fs::create_dir(path).is_ok()
}
