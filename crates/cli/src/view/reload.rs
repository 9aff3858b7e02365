//! Watches files for changes.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Interval of checks.
const EVERY: Duration = Duration::from_millis(300);

/// Files with their modification times.
pub(super) struct Watched {
    files: Vec<(PathBuf, Option<SystemTime>)>,
    looked: Instant,
}

impl Watched {
    /// Starts to watch files.
    pub(super) fn new(files: impl IntoIterator<Item = PathBuf>) -> Self {
        let files = files.into_iter().map(|file| (modified(&file), file)).map(|(time, file)| (file, time));
        Self { files: files.collect(), looked: Instant::now() }
    }

    /// Returns whether any file was written since the last call.
    pub(super) fn changed(&mut self) -> bool {
        if self.looked.elapsed() < EVERY {
            return false;
        }
        self.looked = Instant::now();
        let mut changed = false;
        for (file, before) in &mut self.files {
            let now = modified(file);
            // A file that an editor replaces is missing for a moment.
            if now.is_some() && now != *before {
                (*before, changed) = (now, true);
            }
        }
        changed
    }
}

fn modified(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file).and_then(|data| data.modified()).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_written_file_is_reported_once() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.ron");
        std::fs::write(&file, "1").unwrap();
        let mut watched = Watched::new([file.clone()]);
        let look = |watched: &mut Watched| {
            watched.looked = Instant::now() - EVERY;
            watched.changed()
        };
        assert!(!look(&mut watched));
        let later = SystemTime::now() + Duration::from_secs(5);
        std::fs::File::options().write(true).open(&file).unwrap().set_modified(later).unwrap();
        assert!(look(&mut watched));
        assert!(!look(&mut watched));
        std::fs::remove_file(&file).unwrap();
        assert!(!look(&mut watched), "a removed file is not a change");
    }
}
