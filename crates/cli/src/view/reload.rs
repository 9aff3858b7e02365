//! Files that are looked at again when they are saved.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// How often files are looked at.
const EVERY: Duration = Duration::from_millis(300);

/// Some files, and when they were last written.
pub(super) struct Watched {
    files: Vec<(PathBuf, Option<SystemTime>)>,
    looked: Instant,
}

impl Watched {
    /// Watches files, from how they are now.
    pub(super) fn new(files: impl IntoIterator<Item = PathBuf>) -> Self {
        let files = files.into_iter().map(|file| (written(&file), file)).map(|(time, file)| (file, time));
        Self { files: files.collect(), looked: Instant::now() }
    }

    /// Tells whether any of them was written since the last time.
    pub(super) fn changed(&mut self) -> bool {
        if self.looked.elapsed() < EVERY {
            return false;
        }
        self.looked = Instant::now();
        let mut changed = false;
        for (file, before) in &mut self.files {
            let now = written(file);
            // A file that an editor is just replacing is not there for a moment.
            if now.is_some() && now != *before {
                (*before, changed) = (now, true);
            }
        }
        changed
    }
}

fn written(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file).and_then(|data| data.modified()).ok()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_file_that_is_written_is_told_once() {
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
        assert!(!look(&mut watched), "a file that is gone is no change");
    }
}
