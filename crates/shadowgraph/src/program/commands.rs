//! The commands, one call per step.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::args::{DrawArgs, DumpArgs, ExplainArgs, Format, RenderArgs};
use super::console;
use super::failure::Failure;
use super::progress::Progress;
use super::report;
use crate::core::{Diff, HtmlPage, PassTime, Plan, Timer, trace_json};
use crate::options::{Aov, Options};
use crate::output::{Pixels, write_png, write_text};
use crate::scene::gltf::Progress as LoadProgress;
use crate::scene::{Camera, Scene};
use crate::shadows::{Techniques, Unshadowed};
use crate::{Drawn, Gpu, Method, Picture, Renderer, ViewOptions};

/// What pages are called, with the scene's file behind it.
const TITLE: &str = "Shadowgraph frame";

/// What the page about a scene is called.
fn title(args: &DrawArgs) -> String {
    let file = args.scene.as_deref().and_then(Path::file_name);
    file.map_or(TITLE.into(), |file| format!("{TITLE}: {}", file.to_string_lossy()))
}

/// What every drawing command starts from.
pub(crate) struct Input {
    pub(crate) options: Options,
    pub(crate) scene: Scene,
    pub(crate) camera: Camera,
}

/// `shadowgraph render`
pub(crate) fn render(args: &RenderArgs, techniques: &Techniques) -> Result<(), Failure> {
    check_output(&args.output)?;
    let input = input(&args.draw, techniques)?;
    let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
    let drawn = draw(&gpu, input)?;
    let (pixels, bytes) = file_pixels(&drawn.aov, drawn.view.picture);
    let [width, height] = drawn.size_px;
    write_png(&args.output, width, height, pixels, &bytes)?;
    let (file, adapter) = (args.output.display(), &gpu.adapter.name);
    console::print(&format!("wrote {file}: {width}x{height}, drawn by {adapter}\n"))?;
    if drawn.timings {
        console::print(&report::times(&drawn.view.times, &gpu.adapter))?;
    }
    Ok(())
}

struct DrawnView {
    view: Drawn,
    size_px: [u32; 2],
    aov: Aov,
    timings: bool,
}

fn draw(gpu: &Gpu, input: Input) -> Result<DrawnView, Failure> {
    let _drawing = Progress::if_slow("drawing");
    let Options { aov, timings, pipeline, samples, .. } = input.options.clone();
    let view = view_options(&input);
    let technique = input.options.technique;
    let mut renderer = Renderer::with(
        gpu,
        input.scene,
        &input.camera,
        aov.clone(),
        Method { technique, pipeline, samples },
    )?;
    let mut timer = timings.then(Timer::new);
    if timings {
        // A software driver compiles shaders at the first draw.
        renderer.draw(gpu, &view)?;
    }
    let drawn = renderer.draw_timed(gpu, &view, timer.as_mut())?;
    report::unshadowed(&drawn.unshadowed).iter().for_each(|line| console::warning(line));
    Ok(DrawnView { view: drawn, size_px: view.size_px, aov, timings })
}

/// `shadowgraph dump`
pub(crate) fn dump(args: &DumpArgs, techniques: &Techniques) -> Result<(), Failure> {
    let text = match (&args.diff, args.format) {
        (Some(files), format) => diff(files, format)?,
        (None, Format::Html) => page(&args.draw, input(&args.draw, techniques)?)?,
        (None, format) => plan_text(args, format, input(&args.draw, techniques)?)?,
    };
    match &args.output {
        Some(file) => Ok(write_text(file, &text)?),
        None => console::print(&text),
    }
}

fn plan_text(args: &DumpArgs, format: Format, mut input: Input) -> Result<String, Failure> {
    input.options.timings |= format == Format::Trace;
    let lights = input.scene.lights.clone();
    let (gpu, drawn) = planned(&args.draw, input)?;
    Ok(match format {
        Format::Text if drawn.times.is_empty() => report::text(&lights, &drawn),
        Format::Text => report::text(&lights, &drawn) + "\n" + &report::times(&drawn.times, &gpu.adapter),
        Format::Json => report::json(&lights, &drawn)?,
        Format::Dot => drawn.plan.to_dot(),
        Format::Mermaid => drawn.plan.to_mermaid(),
        Format::Html => drawn.plan.to_html(),
        Format::Trace => trace_json(&drawn.times)?,
    })
}

/// The page about a frame, with pictures where there is something to draw with.
fn page(args: &DrawArgs, input: Input) -> Result<String, Failure> {
    let (lights, notes) = (input.scene.lights.clone(), input.scene.notes.clone());
    let gpu = match Gpu::open(&input.options.adapter) {
        Ok(gpu) => gpu,
        Err(error) if args.names_adapter() || args.times() => return Err(Failure::no_device(error)),
        Err(error) => {
            let (_, Planned { plan, .. }) = planned(args, input)?;
            let mut page = HtmlPage::new(&plan).with_title(&title(args));
            page.notes.push(format!("There are no pictures and no times: {error}."));
            return Ok(page.to_html());
        }
    };
    let _drawing = Progress::if_slow("drawing");
    let view = view_options(&input);
    let Options { aov, technique, pipeline, samples, .. } = input.options;
    let method = Method { technique, pipeline, samples };
    let mut renderer = Renderer::with(&gpu, input.scene, &input.camera, aov, method)?;
    let inspected = renderer.inspect(&gpu, &view)?;
    let mut page = inspected.page(&lights, &view).with_title(&title(args));
    let [width, height] = view.size_px;
    page.notes.push(format!("{width} x {height} pixels, drawn by {}.", gpu.adapter.name));
    page.notes.push(format!("Technique {}, pipeline {}.", technique.name(), pipeline.name()));
    page.notes.extend(notes);
    page.notes.extend(report::unshadowed(&inspected.drawn.unshadowed));
    Ok(page.to_html())
}

/// What differs between the frames of two files.
fn diff(files: &[PathBuf], format: Format) -> Result<String, Failure> {
    let [before, after] = files else { return Err(usage("--diff: takes two files")) };
    let read = |file: &PathBuf| {
        let failed = |error| Failure {
            code: Failure::INPUT,
            message: format!("--diff {}: cannot be read: {error}", file.display()),
        };
        std::fs::read_to_string(file).map_err(failed)
    };
    let diff = Diff::of_json(&read(before)?, &read(after)?).map_err(|error| {
        let named = [("the first", before), ("the second", after)];
        let message = named.iter().fold(error.to_string(), |message, (which, file)| {
            message.replacen(which, &file.display().to_string(), 1)
        });
        Failure { code: Failure::INPUT, message: format!("--diff: {message}") }
    })?;
    let name = |file: &Path| file.file_name().unwrap_or_default().to_string_lossy().into_owned();
    match format {
        Format::Text => Ok(diff.to_text()),
        Format::Json => Ok(serde_json::to_string_pretty(&diff)? + "\n"),
        Format::Html => Ok(diff.to_html(&name(before), &name(after))),
        Format::Dot | Format::Mermaid | Format::Trace => Err(usage("--diff: is shown as text, json or html")),
    }
}

fn usage(message: &str) -> Failure {
    Failure { code: Failure::USAGE, message: message.into() }
}

/// `shadowgraph explain`
pub(crate) fn explain(args: &ExplainArgs, techniques: &Techniques) -> Result<(), Failure> {
    let (_, Planned { plan, .. }) = planned(&args.draw, input(&args.draw, techniques)?)?;
    console::print(&match &args.before {
        Some(after) => plan.explain_order(&args.name, after)?,
        None => plan.explain(&args.name)?,
    })
}

/// A plan needs no GPU, but times do, and an adapter that is named is to be there.
fn planned(args: &DrawArgs, input: Input) -> Result<(Gpu, Planned), Failure> {
    if input.options.timings {
        let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
        let Drawn { plan, times, unshadowed, .. } = draw(&gpu, input)?.view;
        return Ok((gpu, Planned { plan, times, unshadowed }));
    }
    let gpu = if args.names_adapter() {
        Gpu::open(&input.options.adapter).map_err(Failure::no_device)?
    } else {
        Gpu::noop()?
    };
    let view = view_options(&input);
    let Options { aov, technique, pipeline, samples, .. } = input.options;
    let renderer =
        Renderer::with(&gpu, input.scene, &input.camera, aov, Method { technique, pipeline, samples })?;
    let (plan, unshadowed) = renderer.plan(&view)?;
    Ok((gpu, Planned { plan, times: Vec::new(), unshadowed }))
}

/// What `dump` tells.
pub(crate) struct Planned {
    pub(crate) plan: Arc<Plan>,
    /// Empty unless they were asked for.
    pub(crate) times: Vec<PassTime>,
    pub(crate) unshadowed: Vec<Unshadowed>,
}

/// Finds out before anything is drawn that a picture cannot be written.
fn check_output(file: &Path) -> Result<(), Failure> {
    let other = file.extension().filter(|extension| !extension.eq_ignore_ascii_case("png"));
    let reason = match other {
        _ if file.is_dir() => "is a folder; give the name of a PNG file in it".into(),
        Some(extension) => format!("pictures are PNG files, not {}", extension.to_string_lossy()),
        None => return Ok(()),
    };
    Err(Failure { code: Failure::INPUT, message: format!("-o {}: {reason}", file.display()) })
}

/// Parses the options, loads the scene and applies the options to it.
pub(crate) fn input(args: &DrawArgs, techniques: &Techniques) -> Result<Input, Failure> {
    let options = args.options(techniques)?;
    let mut scene = load(args.scene.as_deref())?;
    scene.notes.iter().for_each(|note| console::warning(note));
    if let Some(note) = options.sun.apply(&mut scene) {
        console::warning(&note);
    }
    let camera = options.camera.of(&scene, options.size.aspect())?;
    Ok(Input { options, scene, camera })
}

/// Loads a scene, the built-in one without a file.
pub(crate) fn load(file: Option<&Path>) -> Result<Scene, Failure> {
    match file {
        Some(file) => {
            let loading = Progress::now(&format!("loading {}", file.display()));
            let told = &mut |at: LoadProgress| loading.set(at.stage, at.fraction);
            Ok(crate::scene::gltf::load_with_progress(file, told)?)
        }
        None => Ok(crate::scene::demo::demo_scene()),
    }
}

/// What the options say of the view.
pub(crate) fn view_options(input: &Input) -> ViewOptions {
    let Options { size, settings, shadow_distance, .. } = &input.options;
    let size_px = [size.width_px, size.height_px];
    ViewOptions { camera: input.camera.clone(), size_px, shadows: settings.clone() }
        .with_shadow_distance(*shadow_distance, &input.scene)
}

/// What of a picture goes into the file.
fn file_pixels(aov: &Aov, picture: Picture) -> (Pixels, Vec<u8>) {
    let pixels = picture.rgba8.chunks_exact(4);
    match aov {
        Aov::Visibility(_) => (Pixels::GreyAlpha, pixels.flat_map(|p| [p[0], p[3]]).collect()),
        _ => (Pixels::Rgb, pixels.flat_map(|p| [p[0], p[1], p[2]]).collect()),
    }
}
