//! Reading recordings.

use std::path::Path;

use ron::error::SpannedError;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::entry::{FORMAT, FrameEntry, Header, VERSION};
use super::error::RecordingError;

/// The largest file that is read.
const MAX_MIB: u64 = 1024;
/// The largest number of views of a frame.
const MAX_VIEWS: usize = 16;
/// The largest width and height of a view; those of the device are smaller.
const MAX_SIDE_PX: u32 = 1 << 16;

/// A recording that was read: see [`Replay`](crate::Replay).
#[derive(Clone, Debug)]
pub struct Recording {
    pub(crate) header: Header,
    pub(crate) frames: Vec<FrameEntry>,
}

impl Recording {
    /// Reads a file.
    ///
    /// # Errors
    /// One line with the file and what is wrong.
    pub fn load(file: &Path) -> Result<Self, RecordingError> {
        let name = file.display().to_string();
        let failed = |reason: String| RecordingError::Read { file: name.clone(), reason };
        let bytes = std::fs::metadata(file).map_err(|error| failed(error.to_string()))?.len();
        if bytes > MAX_MIB << 20 {
            return Err(failed(format!("it has {} MiB; expected at most {MAX_MIB}", bytes >> 20)));
        }
        let text = std::fs::read_to_string(file).map_err(|error| failed(error.to_string()))?;
        Self::parse(&name, &text)
    }

    /// Reads the text of a file. Errors name `file`.
    ///
    /// # Errors
    /// One line with the file, the line and what is wrong.
    pub fn parse(file: &str, text: &str) -> Result<Self, RecordingError> {
        let error = |index: usize, reason: String| RecordingError::Line {
            file: file.to_owned(),
            line: index + 1,
            reason,
        };
        let mut lines = text.lines().enumerate();
        let (_, first) = lines.next().unwrap_or_default();
        let header = header(first).map_err(|reason| error(0, reason))?;
        let frames = lines.map(|(index, line)| {
            let is_first = index == 1;
            frame(line, is_first).map_err(|reason| error(index, reason))
        });
        let frames: Vec<_> = frames.collect::<Result<_, _>>()?;
        if frames.is_empty() {
            return Err(error(1, "the recording has no frame".into()));
        }
        if !text.ends_with('\n') {
            return Err(error(frames.len(), "the line is cut off".into()));
        }
        check_views(&frames).map_err(|(index, reason)| error(index + 1, reason))?;
        Ok(Self { header, frames })
    }

    /// Returns how the program finds the scene.
    pub fn source(&self) -> &Value {
        &self.header.source
    }

    /// Returns the number of frames, at least 1.
    pub fn frame_count(&self) -> usize {
        self.frames.len()
    }
}

fn header(line: &str) -> Result<Header, String> {
    let Ok(Kind { format, version }) = ron::from_str(line) else {
        return Err("not a recording of Shadowgraph".into());
    };
    if format != FORMAT {
        return Err("not a recording of Shadowgraph".into());
    }
    if version != VERSION {
        return Err(format!("version {version} of recordings; expected {VERSION}"));
    }
    parse(line)
}

/// What the headers of all versions have.
#[derive(Deserialize)]
struct Kind {
    format: String,
    version: u32,
}

/// Parses a line.
fn parse<T: DeserializeOwned>(line: &str) -> Result<T, String> {
    let described = |error: SpannedError| format!("column {}: {}", error.span.start.col, error.code);
    ron::from_str(line).map_err(|error| described(error).replace('\n', " "))
}

fn frame(line: &str, is_first: bool) -> Result<FrameEntry, String> {
    let entry: FrameEntry = parse(line)?;
    if is_first && entry.renderer.is_none() {
        return Err("the first frame has no `renderer`".into());
    }
    Ok(entry)
}

/// Checks that what frames leave out is in a frame before.
fn check_views(frames: &[FrameEntry]) -> Result<(), (usize, String)> {
    let mut known = 0;
    for (index, frame) in frames.iter().enumerate() {
        let count = frame.views.len();
        if !(1..=MAX_VIEWS).contains(&count) {
            return Err((index, format!("{count} views; expected 1 to {MAX_VIEWS}")));
        }
        for (number, view) in frame.views.iter().enumerate() {
            let is_whole = view.camera.is_some() && view.size_px.is_some() && view.settings.is_some();
            if number >= known && !is_whole {
                return Err((index, format!("view {number} is new and has no camera, size_px or settings")));
            }
            let fits = |side: u32| (1..=MAX_SIDE_PX).contains(&side);
            if !view.size_px.is_none_or(|size_px| size_px.into_iter().all(fits)) {
                return Err((
                    index,
                    format!("view {number}: size_px out of range; expected 1 to {MAX_SIDE_PX}"),
                ));
            }
        }
        known = count;
    }
    Ok(())
}
