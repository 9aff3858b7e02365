//! Reading of the scene file, and of the files in its directory that it refers to.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::uri;

/// The location of the files that a scene refers to.
#[derive(Debug)]
enum Location<'f> {
    /// The scene's directory, canonical.
    Directory(PathBuf),
    /// Paths relative to the scene, with `/`, and contents.
    Memory(&'f [(String, Vec<u8>)]),
}

/// Reads the files that a scene refers to, all of them inside the scene's directory or in memory.
#[derive(Debug)]
pub(super) struct Files<'f> {
    location: Location<'f>,
    /// The number of bytes that may still be read, over all files.
    budget_bytes: AtomicU64,
}

impl<'f> Files<'f> {
    /// Prepares to read files from the directory of `scene`, at most `budget_bytes` in total.
    ///
    /// # Errors
    /// The directory does not exist.
    pub(super) fn in_directory_of(scene: &Path, budget_bytes: u64) -> std::io::Result<Self> {
        let directory = match scene.parent() {
            Some(directory) if !directory.as_os_str().is_empty() => directory,
            _ => Path::new("."),
        };
        let location = Location::Directory(directory.canonicalize()?);
        Ok(Self { location, budget_bytes: AtomicU64::new(budget_bytes) })
    }

    /// Prepares to read files in memory.
    pub(super) fn in_memory(files: &'f [(String, Vec<u8>)]) -> Self {
        Self { location: Location::Memory(files), budget_bytes: AtomicU64::new(u64::MAX) }
    }

    /// Reads the resource of a URI: its data, or a file.
    ///
    /// # Errors
    /// The message says why the URI is rejected or cannot be read.
    pub(super) fn read(&self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri::data(uri) {
            return data;
        }
        let path = uri::relative_path(uri)?;
        let directory = match &self.location {
            Location::Directory(directory) => directory,
            Location::Memory(files) => {
                let found = files.iter().find(|(name, _)| Path::new(name) == path);
                let missing = || format!("{} is not among the files", uri::quote(uri));
                return found.map(|(_, bytes)| bytes.clone()).ok_or_else(missing);
            }
        };
        let path = directory.join(path);
        let fail = |error: std::io::Error| format!("{} cannot be read: {error}", uri::quote(uri));
        let real = path.canonicalize().map_err(fail)?;
        if !real.starts_with(directory) {
            return Err(format!(
                "{} is rejected: it is a link out of the scene's directory",
                uri::quote(uri)
            ));
        }
        let budget_bytes = self.budget_bytes.load(Ordering::Relaxed);
        let bytes = read_file(&real, budget_bytes).map_err(fail)?;
        self.budget_bytes.fetch_sub((bytes.len() as u64).min(budget_bytes), Ordering::Relaxed);
        Ok(bytes)
    }
}

/// Reads a regular file of at most `max_bytes`.
///
/// # Errors
/// The path is not a regular file, or the file is too large or cannot be read.
pub(super) fn read_file(path: &Path, max_bytes: u64) -> std::io::Result<Vec<u8>> {
    // Checked before opening: opening a pipe would wait for its other end.
    if !fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("it is not a regular file"));
    }
    let file = fs::File::open(path)?;
    let length = file.metadata()?.len();
    let too_large = || std::io::Error::other(format!("it has more than {max_bytes} bytes, the limit"));
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
    fn files_in_the_directory_and_below_are_read() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        fs::write(folder.path().join("sub/a b.bin"), b"abc").unwrap();
        let files = Files::in_directory_of(&folder.path().join("scene.gltf"), 4).unwrap();
        assert_eq!(files.read("sub/a%20b.bin").unwrap(), b"abc");
        let reason = files.read("sub/a%20b.bin").unwrap_err();
        assert!(reason.contains("more than 1 bytes"), "the budget counts all files: {reason}");
    }

    #[test]
    fn files_in_memory_are_found_by_their_path() {
        let given = [("sub/a b.bin".to_owned(), b"abc".to_vec())];
        let files = Files::in_memory(&given);
        assert_eq!(files.read("./sub/a%20b.bin").unwrap(), b"abc");
        assert!(files.read("a%20b.bin").unwrap_err().contains("not among the files"));
        assert!(files.read("../a").is_err());
    }

    #[test]
    fn directories_and_missing_files_are_errors() {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("sub")).unwrap();
        let files = Files::in_directory_of(&folder.path().join("scene.gltf"), 1000).unwrap();
        assert!(files.read("sub").unwrap_err().contains("not a regular file"));
        assert!(files.read("none.bin").unwrap_err().contains("cannot be read"));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_only_inside_the_directory() {
        let folder = tempfile::tempdir().unwrap();
        let scene = folder.path().join("scene");
        fs::create_dir(&scene).unwrap();
        fs::write(folder.path().join("secret"), b"secret").unwrap();
        fs::write(scene.join("own"), b"own").unwrap();
        std::os::unix::fs::symlink("../secret", scene.join("out")).unwrap();
        std::os::unix::fs::symlink("own", scene.join("in")).unwrap();
        let files = Files::in_directory_of(&scene.join("scene.gltf"), 1000).unwrap();
        assert_eq!(files.read("in").unwrap(), b"own");
        assert!(files.read("out").unwrap_err().contains("link out of"));
    }
}
