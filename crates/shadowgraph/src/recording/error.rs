//! Errors of recordings.

/// An error of a recording, in one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RecordingError {
    /// The file cannot be read.
    #[error("{file}: cannot be read: {reason}")]
    Read {
        /// The file.
        file: String,
        /// The problem.
        reason: String,
    },
    /// A line of the file is invalid.
    #[error("{file}:{line}: {reason}")]
    Line {
        /// The file.
        file: String,
        /// The line, from 1. The first is the header, and that of frame N is N + 2.
        line: usize,
        /// What is wrong, and what is expected.
        reason: String,
    },
    /// The scene is not the one that was recorded.
    #[error("the scene is not the one of the recording: {what} differ")]
    OtherScene {
        /// What differs.
        what: &'static str,
    },
    /// The recording does not have this frame.
    #[error("the recording has no frame {frame}; expected 0 to {last}")]
    NoFrame {
        /// The frame.
        frame: usize,
        /// The last frame.
        last: usize,
    },
    /// A frame cannot be drawn again.
    #[error("frame {frame} of the recording: {source}")]
    Frame {
        /// The frame.
        frame: usize,
        /// The problem.
        source: Box<crate::Error>,
    },
}
