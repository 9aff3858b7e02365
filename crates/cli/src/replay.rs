//! Frames that were recorded: `--replay`.

use std::path::Path;

use serde::Deserialize;

use super::args::{DrawArgs, RenderArgs};
use super::commands::{self, check_output, file_pixels, use_shaders};
use super::console;
use super::failure::Failure;
use super::frame_files::FrameFiles;
use super::progress::Progress;
use super::recording::{self, Source};
use super::values::{self, Findings};
use shadowgraph::options::{AdapterChoice, GroundChoice, OptionError};
use shadowgraph::output::write_png;
use shadowgraph::recording::{Recording, RecordingError};
use shadowgraph::scene::Scene;
use shadowgraph::{Gpu, Registry, Renderer, Replay, ViewOptions};

/// `shadowgraph render --replay`
pub(crate) fn replay(file: &Path, args: &RenderArgs, registry: &Registry) -> Result<(), Failure> {
    check_output(&args.output)?;
    let files = FrameFiles::parse(&args.output)?;
    let ranges = args.check_values.as_deref();
    let check_values = ranges.map(values::parse).transpose()?;
    let (gpu, recording, scene) = open(file, &args.draw)?;
    let count = recording.frame_count();
    let frames = match (args.replay.frame, &files) {
        (Some(frame), _) => frame as usize..frame as usize + 1,
        (None, FrameFiles::Each { .. }) => 0..count,
        (None, FrameFiles::Last(_)) => count - 1..count,
    };
    let drawing = Progress::if_slow("drawing");
    let mut replay = Replay::new(&recording, scene, registry).map_err(failed)?;
    let mut findings = Findings::default();
    let mut size_px = [0; 2];
    for number in frames.clone() {
        let observe =
            &mut |at: usize| drawing.set(&format!("frame {at} of {count}"), at as f32 / count as f32);
        let (renderer, views) = replay.seek_observed(&gpu, number, observe).map_err(failed)?;
        let view = only(views, number)?;
        renderer.graph().check_values(check_values.clone());
        let drawn = renderer.draw(&gpu, view)?;
        ranges.map_or(Ok(()), |ranges| values::check_names(ranges, &drawn))?;
        findings.add(number as u32, &drawn);
        size_px = view.size_px;
        if let Some(file) = files.file(number as u32, frames.end as u32) {
            let (pixels, bytes) = file_pixels(renderer.aov(), renderer.config().background, &drawn.image);
            write_png(&file, size_px[0], size_px[1], pixels, &bytes)?;
        }
    }
    let [width, height] = size_px;
    let (file, adapter) = (args.output.display(), &gpu.adapter.name);
    let drawn = frames.len();
    let sequence = if drawn > 1 { format!("{drawn} frames, ") } else { format!("frame {}, ", frames.start) };
    console::print(&format!("wrote {file}: {sequence}{width}x{height}, rendered by {adapter}\n"))?;
    if ranges.is_some() { findings.finish(drawn as u32) } else { Ok(()) }
}

/// Draws the frames before one of a recording, by default its last, and hands over the renderer and the view of that frame.
pub(crate) fn with_frame<T>(
    (file, args, registry): (&Path, &DrawArgs, &Registry),
    number: Option<u32>,
    use_frame: impl FnOnce(&Gpu, &mut Renderer, &ViewOptions) -> Result<T, Failure>,
) -> Result<T, Failure> {
    let (gpu, recording, scene) = open(file, args)?;
    let number = number.map_or(recording.frame_count() - 1, |number| number as usize);
    let mut replay = Replay::new(&recording, scene, registry).map_err(failed)?;
    let (renderer, views) = replay.seek_observed(&gpu, number, &mut |_| ()).map_err(failed)?;
    use_frame(&gpu, renderer, only(views, number)?)
}

fn failed(error: RecordingError) -> OptionError {
    OptionError::new("replay", error.to_string())
}

/// Returns the view of a frame of one view.
fn only(views: &[ViewOptions], number: usize) -> Result<&ViewOptions, OptionError> {
    let [view] = views else {
        let reason = format!("frame {number} has {} views; the program draws one", views.len());
        return Err(OptionError::new("replay", reason));
    };
    Ok(view)
}

/// Opens the GPU, a recording, and its scene.
fn open(file: &Path, args: &DrawArgs) -> Result<(Gpu, Recording, Scene), Failure> {
    use_shaders(args)?;
    let adapter: AdapterChoice = args.adapter.as_deref().map_or(Ok(Default::default()), str::parse)?;
    let recording = Recording::load(file).map_err(failed)?;
    let scene = scene(&recording, args).map_err(|failure| Failure {
        message: format!("--replay: {}: {}", file.display(), failure.message),
        ..failure
    })?;
    let gpu = Gpu::open(&adapter).map_err(Failure::no_device)?;
    Ok((gpu, recording, scene))
}

/// Loads the scene of a recording.
fn scene(recording: &Recording, args: &DrawArgs) -> Result<Scene, Failure> {
    let Source { file, hash, variant, procedural, ground } = Source::deserialize(recording.source())?;
    if let Some(file) = file.as_deref().filter(|file| file.exists() && hash != recording::hash(file)) {
        let message = format!("{} has changed since it was recorded", file.display());
        return Err(Failure { code: Failure::INPUT, message });
    }
    let choice: GroundChoice = ground.parse()?;
    let mut scene = commands::scene(&args.with_scene(file, variant, procedural))?;
    choice.place(&scene, true).add_to(&mut scene);
    Ok(scene)
}
