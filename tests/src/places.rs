//! Paths of the repository and of the shared test material.

use std::path::{Path, PathBuf};

/// Returns the repository's root.
#[must_use]
pub fn repository() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
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
