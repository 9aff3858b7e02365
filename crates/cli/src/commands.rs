//! `shadowgraph render`, and the common steps of all drawing commands.

use std::path::Path;

use super::args::{DrawArgs, FramesArgs, RenderArgs};
use super::console;
use super::failure::Failure;
use super::frame_files::FrameFiles;
use super::progress::Progress;
use super::recording;
use super::report;
use super::values::{self, Findings};
use crate::args::options::Options;
use shadowgraph::core::Timer;
use shadowgraph::options::{Aov, CameraChoice, OptionError};
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::recording::Recorder;
use shadowgraph::scene::gltf::{self, LoadOptions, Progress as LoadProgress};
use shadowgraph::scene::{Camera, Scene};
use shadowgraph::shadows::ShadowSettings;
use shadowgraph::{Background, Gpu, Registry, RenderedFrame, RenderedImage, Renderer, ViewOptions};
use shadowgraph_samples::named_scene;

/// The input of every drawing command.
#[derive(Clone)]
pub(crate) struct Input {
    pub(crate) options: Options,
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
    /// What records the frames, if they are.
    pub(crate) recorder: Option<Recorder>,
}

impl Input {
    /// Creates the renderer of the scene.
    pub(crate) fn renderer(self, gpu: &Gpu) -> Result<Renderer, Failure> {
        Ok(self.options.renderer(gpu, self.scene, &self.camera)?)
    }
}

/// `shadowgraph render`
pub(crate) fn render(args: &RenderArgs, registry: &Registry) -> Result<(), Failure> {
    args.replay.file()?;
    check_output(&args.output)?;
    let files = FrameFiles::parse(&args.output)?;
    let ranges = args.check_values.as_deref();
    let check_values = ranges.map(values::parse).transpose()?;
    let mut input = recorded_input(&args.draw, registry, args.record.limit_mib())?;
    input.options.check_values = check_values;
    let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
    let Options { aov, background, timings, .. } = input.options.clone();
    let mut findings = Findings::default();
    let [width, height] = view_options(&input)?.size_px;
    let FramesArgs { count, fps } = args.frames;
    let (drawn, recorder) = draw_frames(&gpu, input, args.frames, &mut |number, frame| {
        ranges.map_or(Ok(()), |ranges| values::check_names(ranges, frame))?;
        findings.add(number, frame);
        let Some(file) = files.file(number, count) else { return Ok(()) };
        let (pixels, bytes) = file_pixels(&aov, background, &frame.image);
        Ok(write_png(&file, width, height, pixels, &bytes)?)
    })?;
    let (file, adapter) = (args.output.display(), &gpu.adapter.name);
    let sequence = match files {
        FrameFiles::Each { .. } => {
            let frames = if count == 1 { "frame" } else { "frames" };
            format!("{count} {frames}, {:.2} s, ", f64::from(count) / fps)
        }
        FrameFiles::Last(_) => String::new(),
    };
    console::print(&format!("wrote {file}: {sequence}{width}x{height}, rendered by {adapter}\n"))?;
    if let (Some(file), Some(recorder)) = (&args.record.file, recorder) {
        recording::write(file, &recorder)?;
    }
    if timings {
        console::print(&report::times(&drawn.times, &gpu.adapter))?;
    }
    if ranges.is_some() { findings.finish(count) } else { Ok(()) }
}

/// Takes a frame and its number.
type Keep<'k> = dyn FnMut(u32, &RenderedFrame) -> Result<(), Failure> + 'k;

/// Draws frames while the animations play, and returns the last, and what has recorded them.
pub(super) fn draw_frames(
    gpu: &Gpu,
    input: Input,
    frames: FramesArgs,
    keep: &mut Keep<'_>,
) -> Result<(RenderedFrame, Option<Recorder>), Failure> {
    let drawing = Progress::if_slow("drawing");
    let timings = input.options.timings;
    let (mut renderer, view) = play(gpu, input, frames, &drawing, keep)?;
    let mut timer = timings.then(Timer::new);
    if timings && frames.count == 1 {
        // A software driver compiles shaders at the first draw.
        renderer.draw(gpu, &view)?;
    }
    let drawn = renderer.draw_timed(gpu, &view, timer.as_mut())?;
    report::unshadowed(&drawn.unshadowed).iter().for_each(|line| console::warning(line));
    let draws_lines = || drawn.plan.passes().any(|(_, pass)| pass.name == "shadow lines");
    if renderer.overlay().is_some() && !draws_lines() {
        console::warning("--overlay draws nothing: the technique has no shadow maps with frusta");
    }
    if *renderer.aov() == Aov::Pages && drawn.counts.shadows.is_empty() {
        console::warning("--aov pages shows what `cascade` does: the technique has no pages");
    }
    drawn.counts.shadow_warning.iter().for_each(|line| console::warning(line));
    keep(frames.count - 1, &drawn)?;
    Ok((drawn, renderer.take_recorder()))
}

/// Draws all frames but the last, and returns the renderer and the view for the last.
pub(super) fn play(
    gpu: &Gpu,
    input: Input,
    frames: FramesArgs,
    drawing: &Progress,
    keep: &mut Keep<'_>,
) -> Result<(Renderer, ViewOptions), Failure> {
    let base = view_options(&input)?;
    let mut view = tracked(&base, &input.options, input.options.time.0)?;
    let shadow_camera = shadow_camera(&input)?;
    let mut renderer = input.options.renderer(gpu, input.scene, &input.camera)?;
    renderer.set_recorder(input.recorder);
    renderer.graph().check_values(input.options.check_values.clone());
    renderer.set_shadow_camera(shadow_camera);
    renderer.set_overlay(gpu, input.options.overlay)?;
    let FramesArgs { count, fps } = frames;
    for number in 1..count {
        keep(number - 1, &renderer.draw(gpu, &view)?)?;
        drawing.set(&format!("frame {number} of {count}"), number as f32 / count as f32);
        let time_s = input.options.time.0 + f64::from(number) / fps;
        view.camera = pose(renderer.scene_mut(), &input.options, time_s, view.camera)?;
        view = tracked(&ViewOptions { camera: view.camera, ..base.clone() }, &input.options, time_s)?;
    }
    Ok((renderer, view))
}

/// Returns a view with the settings of a time and of the place of its camera.
pub(crate) fn tracked(view: &ViewOptions, options: &Options, time_s: f64) -> Result<ViewOptions, Failure> {
    let shadows = options.tracks.settings_for(&view.shadows, time_s, view.camera.position_world());
    Ok(ViewOptions { shadows: shadows.map_err(shadowgraph::Error::from)?, ..view.clone() })
}

/// Moves a scene to a time of its animations, and returns the camera, which moves along if it is one of the scene.
fn pose(scene: &mut Scene, options: &Options, time_s: f64, camera: Camera) -> Result<Camera, Failure> {
    scene.set_time(options.animation.resolve(&scene.hierarchy)?, time_s)?;
    if scene.cameras.is_empty() {
        // The one that framed the scene in the first frame stays.
        return Ok(camera);
    }
    Ok(options.camera.resolve(scene, options.size.aspect())?)
}

/// Checks before drawing that the output is a PNG file.
pub(crate) fn check_output(file: &Path) -> Result<(), Failure> {
    let other = file.extension().filter(|extension| !extension.eq_ignore_ascii_case("png"));
    let reason = match other {
        _ if file.is_dir() => "is a directory; expected a PNG file".into(),
        Some(extension) => format!("unsupported extension `{}`; expected png", extension.to_string_lossy()),
        None => return Ok(()),
    };
    Err(Failure { code: Failure::INPUT, message: format!("-o {}: {reason}", file.display()) })
}

/// Parses the options, loads the scene and applies the options to it.
pub(crate) fn input(args: &DrawArgs, registry: &Registry) -> Result<Input, Failure> {
    recorded_input(args, registry, None)
}

/// Creates an input like [`input`], with a recorder if there is a limit to its size, MiB.
pub(crate) fn recorded_input(
    args: &DrawArgs,
    registry: &Registry,
    record_mib: Option<u32>,
) -> Result<Input, Failure> {
    use_shaders(args)?;
    let options = args.options(registry)?;
    // A requested texture may belong to a node that no output depends on.
    if !matches!(options.aov, Aov::Texture(_)) {
        options.pipeline.warnings().iter().for_each(|note| console::warning(&note.to_string()));
    }
    let mut scene = scene(args)?;
    scene.notes.iter().for_each(|note| console::warning(note));
    let shows_ground = options.aov == Aov::Color && options.pipeline.has_sky();
    let ground = options.ground.place(&scene, shows_ground);
    let recorder = record_mib.map(|limit_mib| {
        let mut loaded = scene.clone();
        ground.add_to(&mut loaded);
        recording::recorder(args, &loaded, limit_mib)
    });
    scene.set_time(options.animation.resolve(&scene.hierarchy)?, options.time.0)?;
    if let Some(note) = options.sun.apply(&mut scene) {
        console::warning(&note);
    }
    args.check_lights(&options.settings, &scene)?;
    apply_shadow_modes(&options.settings, &mut scene);
    let mut camera = options.camera.resolve(&scene, options.size.aspect())?;
    let frames = scene.cameras.is_empty() && options.camera == CameraChoice::Default;
    if ground.add_to(&mut scene) && frames {
        camera.set_far(None);
    }
    Ok(Input { options, scene, camera, recorder })
}

/// Replaces the built-in shaders by those of a directory, if one is given.
pub(crate) fn use_shaders(args: &DrawArgs) -> Result<(), Failure> {
    if let Some(folder) = &args.shaders {
        check_shaders(folder)?;
        shadowgraph::shaders::set_folder(Some(folder.clone()));
    }
    Ok(())
}

/// Checks that a directory has shaders.
fn check_shaders(folder: &Path) -> Result<(), Failure> {
    let reason = match folder {
        folder if !folder.is_dir() => "is not a directory",
        folder if !shadowgraph::shaders::builtin_files().any(|file| folder.join(file).is_file()) => {
            "contains no file with the name of a built-in shader, such as forward.wgsl"
        }
        _ => return Ok(()),
    };
    Err(Failure { code: Failure::INPUT, message: format!("--shaders {}: {reason}", folder.display()) })
}

/// Applies the shadow modes by name, and warns of names that nothing has.
fn apply_shadow_modes(settings: &ShadowSettings, scene: &mut Scene) {
    let materials = scene.materials().map(|(_, material)| &*material.name);
    let objects = scene.instances().map(|(_, instance)| &*instance.name);
    let materials = settings.materials.unused(materials).map(|name| ("materials", name));
    for (setting, name) in materials.chain(settings.objects.unused(objects).map(|name| ("objects", name))) {
        console::warning(&format!("settings: `{setting}.{name:?}` matches no name of the scene"));
    }
    scene.set_shadow_modes(settings.shadow_modes());
}

/// Loads the scene of the arguments; without a file, creates a procedural one.
pub(crate) fn scene(args: &DrawArgs) -> Result<Scene, Failure> {
    let variant = args.variant.as_deref();
    if let Some(file) = &args.scene {
        return load(file, variant);
    }
    if variant.is_some() {
        return Err(OptionError::new("variant", "only files have variants").into());
    }
    let name = args.procedural.as_deref().unwrap_or("demo");
    Ok(named_scene(name).map_err(|error| OptionError::new("scene", error.to_string()))?)
}

/// Loads a file with a variant of its materials.
pub(crate) fn load(file: &Path, variant: Option<&str>) -> Result<Scene, Failure> {
    let loading = Progress::now(&format!("loading {}", file.display()));
    let report = &mut |at: LoadProgress| loading.set(at.stage, at.fraction);
    let options = LoadOptions { variant: variant.map(str::to_owned) };
    let scene = gltf::load_with(file, &options, report)?;
    if scene.instances().len() > 0 {
        return Ok(scene);
    }
    let reason = scene.notes.first().map_or("the scene has no meshes", String::as_str);
    let message = format!("{}: nothing to draw: {reason}", file.display());
    Err(Failure { code: Failure::INPUT, message })
}

/// Returns the view according to the options.
pub(crate) fn view_options(input: &Input) -> Result<ViewOptions, Failure> {
    let Options { size, settings, shadow_distance, .. } = &input.options;
    let size_px = [size.width_px, size.height_px];
    let camera = shadow_camera(input)?.unwrap_or_else(|| input.camera.clone());
    let of_shadows = ViewOptions { camera, size_px, shadows: settings.clone() };
    let of_shadows = of_shadows.with_shadow_distance(*shadow_distance, &input.scene);
    Ok(ViewOptions { camera: input.camera.clone(), ..of_shadows })
}

/// Returns the camera that shadows are fitted to, if it is not that of the image.
pub(crate) fn shadow_camera(input: &Input) -> Result<Option<Camera>, Failure> {
    let Options { shadow_camera, size, .. } = &input.options;
    let camera = shadow_camera.as_ref().map(|camera| camera.resolve(&input.scene, size.aspect()));
    Ok(camera.transpose().map_err(|error| OptionError { option: "shadow_camera", ..error })?)
}

/// Returns the channels of an image that are written to the file.
pub(crate) fn file_pixels(aov: &Aov, background: Background, image: &RenderedImage) -> (Pixels, Vec<u8>) {
    let pixels = image.rgba8.chunks_exact(4);
    match aov {
        Aov::Visibility(_) => (Pixels::GreyAlpha, pixels.flat_map(|p| [p[0], p[3]]).collect()),
        Aov::Color if background == Background::Transparent => (Pixels::Rgba, image.straight_alpha()),
        _ => (Pixels::Rgb, pixels.flat_map(|p| [p[0], p[1], p[2]]).collect()),
    }
}
