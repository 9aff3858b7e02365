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
    /// The hash of the file's bytes, which other files that it names are not part of.
    pub(crate) hash: Option<String>,
    pub(crate) variant: Option<String>,
    /// The name of a procedural scene.
    pub(crate) procedural: Option<String>,
    pub(crate) ground: String,
}

/// Creates the recorder of a scene as it was loaded, with its ground.
pub(crate) fn recorder(args: &DrawArgs, scene: &Scene, limit_mib: u32) -> Recorder {
    let DrawArgs { scene: file, variant, procedural, ground, .. } = args;
    let file = file.as_ref().map(|file| std::path::absolute(file).unwrap_or_else(|_| file.clone()));
    let hash = file.as_deref().and_then(hash);
    let file = file.map(|file| file.to_string_lossy().into_owned());
    let source =
        json!({ "file": file, "hash": hash, "variant": variant, "procedural": procedural, "ground": ground });
    Recorder::new(scene, source, limit_mib)
}

/// Returns the hash of a scene's file (XXH3, 64 bits), if it can be read.
pub(crate) fn hash(file: &Path) -> Option<String> {
    let bytes = std::fs::read(file).ok()?;
    Some(format!("{:016x}", xxhash_rust::xxh3::xxh3_64(&bytes)))
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
