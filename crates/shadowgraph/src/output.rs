//! Files that are written completely or not at all.

use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// An error while a file is written. The message is one line; no partial file is left.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The path is not the name of a file.
    #[error("{}: not a file name", file.display())]
    NotAFile {
        /// The path.
        file: PathBuf,
    },
    /// The system returned an error.
    #[error("{}: cannot be written: {source}", file.display())]
    Write {
        /// The file.
        file: PathBuf,
        /// The system's error.
        source: io::Error,
    },
    /// The number of bytes does not match the size.
    #[error("{}: an image of {width_px}x{height_px} pixels needs {expected} bytes, not {given}", file.display())]
    Pixels {
        /// The file.
        file: PathBuf,
        /// Width, pixels.
        width_px: u32,
        /// Height, pixels.
        height_px: u32,
        /// Bytes that the size needs.
        expected: u64,
        /// Bytes that were given.
        given: u64,
    },
}

/// The pixel format of a PNG: 8 bits per channel, rows from the top without padding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixels {
    /// One channel.
    Grey,
    /// Grey and alpha.
    GreyAlpha,
    /// sRGB colours without alpha.
    Rgb,
    /// sRGB colours with straight alpha.
    Rgba,
}

impl Pixels {
    fn color(self) -> image::ExtendedColorType {
        match self {
            Self::Grey => image::ExtendedColorType::L8,
            Self::GreyAlpha => image::ExtendedColorType::La8,
            Self::Rgb => image::ExtendedColorType::Rgb8,
            Self::Rgba => image::ExtendedColorType::Rgba8,
        }
    }
}

/// Writes a PNG. Missing directories are created; an older file is replaced only by a complete new one.
///
/// ```
/// use shadowgraph::output::{Pixels, write_png};
/// let directory = tempfile::tempdir()?;
/// let file = directory.path().join("new/directory/grey.png");
/// write_png(&file, 2, 1, Pixels::Grey, &[0, 255])?;
/// assert!(file.is_file());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the bytes are not `width_px * height_px` pixels, or the file cannot be written.
pub fn write_png(
    file: &Path,
    width_px: u32,
    height_px: u32,
    pixels: Pixels,
    bytes: &[u8],
) -> Result<(), OutputError> {
    let channels = u64::from(pixels.color().channel_count());
    let (expected, given) = (u64::from(width_px) * u64::from(height_px) * channels, bytes.len() as u64);
    if expected != given || given == 0 {
        return Err(OutputError::Pixels { file: file.to_owned(), width_px, height_px, expected, given });
    }
    write_atomically(file, &mut |out| {
        let encoder = image::codecs::png::PngEncoder::new(out);
        let done = image::ImageEncoder::write_image(encoder, bytes, width_px, height_px, pixels.color());
        done.map_err(|error| match error {
            image::ImageError::IoError(error) => error,
            other => io::Error::other(other),
        })
    })
}

/// Writes text. Missing directories are created; an older file is replaced only by a complete new one.
///
/// # Errors
/// If the path is not the name of a file, or the file cannot be written.
pub fn write_text(file: &Path, text: &str) -> Result<(), OutputError> {
    write_atomically(file, &mut |out| out.write_all(text.as_bytes()))
}

/// Writes bytes. Missing directories are created; an older file is replaced only by a complete new one.
///
/// # Errors
/// As [`write_text`].
pub fn write_bytes(file: &Path, bytes: &[u8]) -> Result<(), OutputError> {
    write_atomically(file, &mut |out| out.write_all(bytes))
}

/// Writes a temporary file next to the file and renames it at the end, so that nobody reads a partial file.
fn write_atomically(
    file: &Path,
    write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>,
) -> Result<(), OutputError> {
    if file.file_name().is_none() || file.is_dir() {
        return Err(OutputError::NotAFile { file: file.to_owned() });
    }
    let error = |source: io::Error| OutputError::Write { file: file.to_owned(), source };
    let target = match std::fs::metadata(file) {
        // A device or a pipe is not replaced.
        Ok(data) if !data.is_file() => return write_into_device(file, write).map_err(error),
        // A symbolic link stays a link.
        Ok(_) => std::fs::canonicalize(file).map_err(error)?,
        Err(_) => file.to_owned(),
    };
    let directory =
        target.parent().filter(|directory| !directory.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(directory).map_err(error)?;
    let temporary = TemporaryFile::create(directory).map_err(error)?;
    let mut out = BufWriter::new(&temporary.file);
    write(&mut out).and_then(|()| out.flush()).map_err(error)?;
    drop(out);
    temporary.rename(&target).map_err(error)
}

fn write_into_device(file: &Path, write: &mut dyn FnMut(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::new(std::fs::OpenOptions::new().write(true).open(file)?);
    write(&mut out)?;
    out.flush()
}

/// A new file with a unique name, removed when dropped.
struct TemporaryFile {
    file: File,
    path: PathBuf,
}

impl TemporaryFile {
    fn create(directory: &Path) -> io::Result<Self> {
        static NEXT: AtomicU64 = AtomicU64::new(0);
        loop {
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let path = directory.join(format!(".shadowgraph-{}-{number}.part", std::process::id()));
            match File::create_new(&path) {
                // Left behind by a killed process with the same id.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
                created => return created.map(|file| Self { file, path }),
            }
        }
    }

    /// Replaces `target` by the file in one step.
    fn rename(self, target: &Path) -> io::Result<()> {
        std::fs::rename(&self.path, target)
    }
}

impl Drop for TemporaryFile {
    fn drop(&mut self) {
        // Absent after a rename.
        let _absent = std::fs::remove_file(&self.path);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    fn entries(directory: &Path) -> Vec<String> {
        let names = std::fs::read_dir(directory).unwrap().map(|entry| entry.unwrap().file_name());
        names.map(|name| name.into_string().unwrap()).collect()
    }

    #[test]
    fn an_image_reads_back_as_written() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("a/b/image.png");
        write_png(&file, 1, 2, Pixels::GreyAlpha, &[10, 255, 20, 0]).unwrap();
        let read = image::open(&file).unwrap();
        assert_eq!(read.as_luma_alpha8().unwrap().as_raw(), &[10, 255, 20, 0]);
    }

    #[test]
    fn an_older_file_is_replaced_and_nothing_else_is_left() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("plan.txt");
        write_text(&file, "old and longer").unwrap();
        write_text(&file, "new").unwrap();
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
        assert_eq!(entries(directory.path()), ["plan.txt"]);
    }

    #[test]
    fn an_error_half_way_keeps_the_older_file_and_leaves_nothing_else() {
        let directory = tempfile::tempdir().unwrap();
        let file = directory.path().join("plan.txt");
        write_text(&file, "old").unwrap();
        let fail = write_atomically(&file, &mut |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the disk is full"))
        });
        assert!(fail.unwrap_err().to_string().ends_with("plan.txt: cannot be written: the disk is full"));
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "old");
        assert_eq!(entries(directory.path()), ["plan.txt"]);
    }

    #[test]
    fn too_few_pixels_are_refused_before_anything_is_written() {
        let directory = tempfile::tempdir().unwrap();
        let error = write_png(&directory.path().join("a.png"), 2, 2, Pixels::Rgba, &[0; 15]).unwrap_err();
        assert!(error.to_string().ends_with("an image of 2x2 pixels needs 16 bytes, not 15"));
        assert!(write_png(&directory.path().join("a.png"), 0, 2, Pixels::Rgba, &[]).is_err());
        assert_eq!(entries(directory.path()), Vec::<String>::new());
    }

    #[test]
    fn a_path_that_is_not_a_file_is_refused() {
        let directory = tempfile::tempdir().unwrap();
        let plain = directory.path().join("plain");
        write_text(&plain, "x").unwrap();
        for path in
            [directory.path().to_owned(), directory.path().join(".."), PathBuf::new(), plain.join("below")]
        {
            assert!(write_text(&path, "x").is_err(), "{}", path.display());
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_device_is_written_to_and_stays_a_device() {
        write_text(Path::new("/dev/null"), "gone").unwrap();
        assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_new_file_is_readable_by_the_group() {
        use std::os::unix::fs::PermissionsExt;
        let directory = tempfile::tempdir().unwrap();
        let (file, link) = (directory.path().join("file"), directory.path().join("link"));
        write_text(&file, "old").unwrap();
        let ordinary = directory.path().join("ordinary");
        std::fs::write(&ordinary, "").unwrap();
        let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&file), mode(&ordinary));
        std::os::unix::fs::symlink(&file, &link).unwrap();
        write_text(&link, "new").unwrap();
        assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(std::fs::read_to_string(&file).unwrap(), "new");
    }
}
