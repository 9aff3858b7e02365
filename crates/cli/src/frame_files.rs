//! The files of the frames of `render`.

use std::path::{Path, PathBuf};

use super::failure::Failure;

/// Maximum number of digits of a frame's number.
const MAX_DIGITS: usize = 9;

/// The name of a file, or the pattern of the names of all frames.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum FrameFiles {
    /// One file, for the last frame.
    Last(PathBuf),
    /// A file for each frame: its number, with at least `digits` digits, between two texts.
    Each { before: String, digits: usize, after: String },
}

impl FrameFiles {
    /// Reads a path: `%d`, or `%04d` with at least 4 digits, stands for the number of the frame, from 0.
    ///
    /// # Errors
    /// For several numbers, and for another format of the number.
    pub(crate) fn parse(path: &Path) -> Result<Self, Failure> {
        let Some(text) = path.to_str() else { return Ok(Self::Last(path.to_owned())) };
        let failed =
            |problem: String| Failure { code: Failure::INPUT, message: format!("-o {text}: {problem}") };
        let mut numbers =
            text.match_indices('%').filter_map(|(at, _)| Some((at, number_length(&text[at..])?)));
        let Some((at, length)) = numbers.next() else { return Ok(Self::Last(path.to_owned())) };
        if numbers.next().is_some() {
            return Err(failed("several numbers; expected one, such as frame-%04d.png".into()));
        }
        let (number, after) = text[at..].split_at(length);
        let digits = match &number[1..length - 1] {
            "" => Some(1),
            width => width.strip_prefix('0').and_then(|width| width.parse().ok()),
        };
        match digits.filter(|digits| (1..=MAX_DIGITS).contains(digits)) {
            Some(digits) => Ok(Self::Each { before: text[..at].to_owned(), digits, after: after.to_owned() }),
            None => {
                Err(failed(format!("unsupported number `{number}`; expected %d, or %01d to %0{MAX_DIGITS}d")))
            }
        }
    }

    /// Returns the file of a frame of a sequence; `None` if it is not kept.
    pub(crate) fn file(&self, number: u32, frames: u32) -> Option<PathBuf> {
        match self {
            Self::Last(file) => (number + 1 == frames).then(|| file.clone()),
            Self::Each { before, digits, after } => Some(format!("{before}{number:0digits$}{after}").into()),
        }
    }
}

/// Returns the length of a number such as `%04d` at the beginning of a text.
fn number_length(text: &str) -> Option<usize> {
    let digits = text[1..].find(|c: char| !c.is_ascii_digit())?;
    text[1 + digits..].starts_with('d').then_some(digits + 2)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn names(path: &str, frames: u32) -> Vec<String> {
        let files = FrameFiles::parse(Path::new(path)).unwrap();
        let names = (0..frames).filter_map(|number| files.file(number, frames));
        names.map(|name| name.to_str().unwrap().to_owned()).collect()
    }

    #[test]
    fn a_number_in_the_name_gives_each_frame_a_file() {
        assert_eq!(names("a/b-%04d.png", 3), ["a/b-0000.png", "a/b-0001.png", "a/b-0002.png"]);
        assert_eq!(names("%d.png", 11)[9..], ["9.png", "10.png"]);
        assert_eq!(names("a.png", 3), ["a.png"]);
        assert_eq!(names("100%.png", 3), ["100%.png"]);
    }

    #[test]
    fn any_other_number_is_an_error_of_one_line() {
        for (path, problem) in [
            ("a-%4d.png", "-o a-%4d.png: unsupported number `%4d`; expected %d, or %01d to %09d"),
            ("a-%00d.png", "-o a-%00d.png: unsupported number `%00d`; expected %d, or %01d to %09d"),
            ("a-%012d.png", "-o a-%012d.png: unsupported number `%012d`; expected %d, or %01d to %09d"),
            ("%d-%02d.png", "-o %d-%02d.png: several numbers; expected one, such as frame-%04d.png"),
        ] {
            assert_eq!(FrameFiles::parse(Path::new(path)).unwrap_err().message, problem);
        }
    }
}
