//! Shared by the tests of the whole workspace: paths, skips, the built program.

pub mod animated;
pub mod copies;
pub mod edits;
pub mod features;
pub mod gltf_file;
pub mod ktx2;
pub mod planted;
mod program;
pub mod random;
pub mod shares;
pub mod watch;

pub use program::{ProgramError, on_path, program};

use shadowgraph::options::AdapterChoice;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Returns the repository's root, or the directory that the variable `SHADOWGRAPH_REPOSITORY` names: one with the files that tests
/// read, where they run on a machine without the repository.
#[must_use]
pub fn repository() -> PathBuf {
    if let Some(root) = std::env::var_os("SHADOWGRAPH_REPOSITORY") {
        return root.into();
    }
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// Returns the adapter that the variable `SHADOWGRAPH_ADAPTER` names, as the option `--adapter` does; by default any.
#[must_use]
pub fn adapter() -> AdapterChoice {
    std::env::var("SHADOWGRAPH_ADAPTER").ok().and_then(|name| name.parse().ok()).unwrap_or_default()
}

/// Returns a directory of the test material that is not in the repository, if this machine has it.
///
/// It is a subdirectory of the one that the variable `SHADOWGRAPH_SHARED` names, by default of `shared` next to
/// the repository.
#[must_use]
pub fn shared(dir: &str) -> Option<PathBuf> {
    let base = match std::env::var_os("SHADOWGRAPH_SHARED") {
        Some(base) => PathBuf::from(base),
        None => repository().parent()?.join("shared"),
    };
    Some(base.join(dir)).filter(|path| path.is_dir())
}

/// Returns the directory into which tests write images of the documents: `cargo xtask docs` sets it.
#[must_use]
pub fn images() -> Option<PathBuf> {
    std::env::var_os("SHADOWGRAPH_IMAGES").map(PathBuf::from)
}

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
