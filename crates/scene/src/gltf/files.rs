//! Reading files: the scene's own, and those beside it that it refers to.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::uri;

/// Reads the files that a scene refers to, all of them inside the scene's folder.
#[derive(Debug)]
pub(super) struct Files {
    /// The scene's folder, canonical.
    folder: PathBuf,
    /// How many bytes may still be read, over all files.
    budget_bytes: AtomicU64,
}

impl Files {
    /// Prepares to read files beside `scene`, at most `budget_bytes` together.
    ///
    /// # Errors
    /// If the folder does not exist.
    pub(super) fn beside(scene: &Path, budget_bytes: u64) -> std::io::Result<Self> {
        let folder = match scene.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        Ok(Self { folder: folder.canonicalize()?, budget_bytes: AtomicU64::new(budget_bytes) })
    }

    /// Reads what a URI stands for: the data in it, or a file in the scene's folder.
    ///
    /// # Errors
    /// Says why the URI is refused or cannot be read.
    pub(super) fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri::data(uri) {
            return data;
        }
        let path = self.folder.join(uri::relative_path(uri)?);
        let fail = |error: std::io::Error| format!("{} cannot be read: {error}", uri::shown(uri));
        let real = path.canonicalize().map_err(fail)?;
        if !real.starts_with(&self.folder) {
            return Err(format!(
                "{} is refused: it is a link out of the scene's own folder",
                uri::shown(uri)
            ));
        }
        let budget_bytes = self.budget_bytes.load(Ordering::Relaxed);
        let bytes = read_file(&real, budget_bytes).map_err(fail)?;
        self.budget_bytes.fetch_sub((bytes.len() as u64).min(budget_bytes), Ordering::Relaxed);
        Ok(bytes)
    }
}

/// Reads an ordinary file of at most `max_bytes`.
///
/// # Errors
/// If it is a folder, a pipe or the like, is too large, or cannot be read.
pub(super) fn read_file(path: &Path, max_bytes: u64) -> std::io::Result<Vec<u8>> {
    // Asked before opening: opening a pipe would wait for its other end.
    if !fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not an ordinary file"));
    }
    let file = fs::File::open(path)?;
    let length = file.metadata()?.len();
    let too_large = || std::io::Error::other(format!("it has over {max_bytes} bytes, the most that is read"));
    if length > max_bytes {
        return Err(too_large());
    }
    let mut bytes = Vec::with_capacity(usize::try_from(length).map_err(|_| too_large())?);
    file.take(max_bytes).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn files_in_the_folder_and_below_are_read() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(folder.path().join("sub/a b.bin"), b"abc").unwrap();
        let files = Files::beside(&folder.path().join("scene.gltf"), 4).unwrap();
        assert_eq!(files.read("sub/a%20b.bin").unwrap(), b"abc");
        let reason = files.read("sub/a%20b.bin").unwrap_err();
        assert!(reason.contains("over 1 bytes"), "the budget counts all files: {reason}");
    }

    #[test]
    fn folders_and_missing_files_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        let files = Files::beside(&folder.path().join("scene.gltf"), 1000).unwrap();
        assert!(files.read("sub").unwrap_err().contains("not an ordinary file"));
        assert!(files.read("none.bin").unwrap_err().contains("cannot be read"));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_only_inside_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene");
        fs::create_dir(&scene).unwrap();
        fs::write(folder.path().join("secret"), b"secret").unwrap();
        fs::write(scene.join("own"), b"own").unwrap();
        std::os::unix::fs::symlink("../secret", scene.join("out")).unwrap();
        std::os::unix::fs::symlink("own", scene.join("in")).unwrap();
        let files = Files::beside(&scene.join("scene.gltf"), 1000).unwrap();
        assert_eq!(files.read("in").unwrap(), b"own");
        assert!(files.read("out").unwrap_err().contains("link out of"));
    }
}
