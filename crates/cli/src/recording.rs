//! Recordings of frames: `--record`.

use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::json;

use super::args::DrawArgs;
use super::console;
use super::failure::Failure;
use shadowgraph::output::write_text;
use shadowgraph::recording::Recorder;
use shadowgraph::scene::Scene;

/// Where the scene of a recording is from.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Source {
    /// Absolute.
    pub(crate) file: Option<PathBuf>,
    pub(crate) variant: Option<String>,
    /// The name of a procedural scene.
    pub(crate) procedural: Option<String>,
    pub(crate) ground: String,
}

/// Creates the recorder of a scene as it was loaded, with its ground.
pub(crate) fn recorder(args: &DrawArgs, scene: &Scene, limit_mib: u32) -> Recorder {
    let DrawArgs { scene: file, variant, procedural, ground, .. } = args;
    let file = file.as_ref().map(|file| std::path::absolute(file).unwrap_or_else(|_| file.clone()));
    let file = file.map(|file| file.to_string_lossy().into_owned());
    let source = json!({ "file": file, "variant": variant, "procedural": procedural, "ground": ground });
    Recorder::new(scene, source, limit_mib)
}

/// Writes the file of a recorder.
pub(crate) fn write(file: &Path, recorder: &Recorder) -> Result<(), Failure> {
    let count = recorder.frame_count();
    if let Some(reason) = recorder.ended_because() {
        console::warning(&format!("the recording ends before frame {count}: {reason}"));
    }
    if count == 0 {
        return Ok(());
    }
    write_text(file, recorder.text())?;
    console::print(&format!("wrote {}: {count} frames\n", file.display()))
}
