//! `shadowgraph dump` and `shadowgraph explain`.

use std::path::{Path, PathBuf};

use super::args::{DrawArgs, DumpArgs, ExplainArgs, Format, FramesArgs};
use super::commands::{Input, draw_frames, input, play, view_options};
use super::console;
use super::failure::Failure;
use super::progress::Progress;
use super::report::{self, Planned};
use shadowgraph::inspect::{
    self, ContentsRecorder, Dump, HtmlPage, PageTable, Tolerance, lights, trace_json,
};
use shadowgraph::output::{write_bytes, write_text};
use shadowgraph::{FrameCounts, Gpu, Pipeline, Registry, RenderedFrame};

/// Title of pages, followed by the file of the scene.
const TITLE: &str = "Shadowgraph frame";

/// `shadowgraph dump`
pub(crate) fn dump(args: &DumpArgs, registry: &Registry) -> Result<(), Failure> {
    let text = match (&args.diff, args.format()?) {
        (Some(files), format) => {
            diff(files, format, Tolerance { relative: args.tolerance, outliers: args.outliers })?
        }
        (None, Format::Json) if args.hashes => hashes(args, input(&args.draw, registry)?)?,
        (None, _) if args.hashes => return Err(usage("--hashes: the format is json, as of -o frame.json")),
        (None, Format::Html) => page(args, input(&args.draw, registry)?)?,
        (None, format) => plan_text(args, format, input(&args.draw, registry)?)?,
    };
    match &args.output {
        Some(file) => {
            write_text(file, &text)?;
            console::print(&format!("wrote {}\n", file.display()))
        }
        None => console::print(&text),
    }
}

fn plan_text(args: &DumpArgs, format: Format, mut input: Input) -> Result<String, Failure> {
    input.options.timings |= format == Format::Trace;
    let lights = input.scene.lights().to_vec();
    let (gpu, drawn) = planned(&args.draw, args.frames, input)?;
    Ok(match format {
        Format::Text if drawn.times.is_empty() => report::text(&lights, &drawn),
        Format::Text => {
            let times = report::times(&drawn.times, &gpu.adapter);
            [&report::text(&lights, &drawn), "\n", &times, &report::counts(&drawn.counts)].concat()
        }
        Format::Json => report::json(&lights, &drawn, None)?,
        Format::Dot => drawn.plan.to_dot(),
        Format::Mermaid => drawn.plan.to_mermaid(),
        Format::Html => inspect::to_html(&drawn.plan),
        Format::Trace => trace_json(&drawn.times)?,
    })
}

/// Returns the page of a frame, with images if there is a GPU.
fn page(args: &DumpArgs, input: Input) -> Result<String, Failure> {
    let DumpArgs { draw: args, frames, .. } = args;
    let view = view_options(&input)?;
    let config = input.options.render_config();
    let (scene_lights, mut notes) = (input.scene.lights().to_vec(), input.scene.notes.clone());
    let [width, height] = view.size_px;
    notes.insert(
        0,
        format!(
            "{width} x {height} pixels, technique {}, pipeline {}.",
            config.technique().name(),
            config.pipeline.name()
        ),
    );
    let mut finish = |mut page: HtmlPage<'_>| {
        let file = args.scene.as_deref().and_then(Path::file_name).map(|file| file.to_string_lossy());
        let name = file.or(args.procedural.as_deref().map(Into::into));
        let title = name.map_or(TITLE.into(), |name| format!("{TITLE}: {name}"));
        page.notes.append(&mut notes);
        page.with_title(&title).to_html()
    };
    let gpu = match Gpu::open(&input.options.adapter) {
        Ok(gpu) => gpu,
        Err(error) if args.names_adapter() || args.times() => return Err(Failure::no_device(error)),
        Err(error) => {
            let missing = format!("no images and no times: {error}");
            console::warning(&missing);
            let (_, Planned { plan, unshadowed, .. }) = planned(args, *frames, input)?;
            let mut page = lights::page(&plan, &[], &scene_lights, &unshadowed);
            page.notes.push(missing);
            return Ok(finish(page));
        }
    };
    let drawing = Progress::if_slow("drawing");
    let (mut renderer, view) = play(&gpu, input, *frames, &drawing, &mut |_, _| Ok(()))?;
    let inspected = renderer.inspect(&gpu, &view)?;
    let mut page = inspected.page(&scene_lights, &view);
    page.notes.push(format!("Rendered by {}.", gpu.adapter.name));
    page.notes.extend(report::unshadowed(&inspected.frame.unshadowed));
    let FrameCounts { shadows, shadow_warning, .. } = &inspected.frame.counts;
    page.notes.extend(shadow_warning.clone());
    if !shadows.is_empty() {
        let rows = shadows.iter().map(|(name, count)| vec![(*name).to_owned(), count.to_string()]).collect();
        let columns = vec!["shadows".to_owned(), "number".to_owned()];
        page.tables.push(PageTable { title: "Shadow maps".into(), columns, rows });
    }
    let kept = "Shadow maps are drawn as in a first frame; `explain cascades --frames 3` says what the third one keeps.";
    page.notes.push(kept.into());
    Ok(finish(page))
}

/// Draws the last of some frames, writes the file of values, and returns the dump.
fn hashes(args: &DumpArgs, input: Input) -> Result<String, Failure> {
    let lights = input.scene.lights().to_vec();
    let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
    let drawing = Progress::if_slow("drawing");
    let (mut renderer, view) = play(&gpu, input, args.frames, &drawing, &mut |_, _| Ok(()))?;
    let mut recorder = ContentsRecorder::new((args.values_mib as usize) << 20);
    let RenderedFrame { plan, unshadowed, counts, .. } =
        renderer.record_contents(&gpu, &view, &mut recorder)?;
    if let left_out @ 1.. = recorder.left_out() {
        console::warning(&format!(
            "{left_out} versions of textures and buffers have only a hash: their values exceed --values-mib {}",
            args.values_mib
        ));
    }
    let planned = Planned { plan, times: Vec::new(), unshadowed, counts };
    let text = report::json(&lights, &planned, Some(recorder.to_json()?))?;
    if let Some(file) = args.output.as_deref().map(values_file) {
        write_bytes(&file, &recorder.into_values())?;
        console::print(&format!("wrote {}\n", file.display()))?;
    }
    Ok(text)
}

/// Returns the file of values next to a dump.
fn values_file(dump: &Path) -> PathBuf {
    dump.with_extension("values")
}

/// Returns the differences between the frames of two files.
fn diff(files: &[PathBuf], format: Format, tolerance: Tolerance) -> Result<String, Failure> {
    let [before, after] = files else { return Err(usage("--diff: expected two files")) };
    let (read_before, read_after) = (read(before)?, read(after)?);
    let failed = |problem| Failure { code: Failure::INPUT, message: format!("--diff: {problem}") };
    if read_before.has_contents() != read_after.has_contents() {
        let without = if read_before.has_contents() { after } else { before };
        console::warning(&format!("contents are not compared: {} has none (--hashes)", without.display()));
    }
    let diff = read_before.diff_with_contents(&read_after, tolerance).map_err(failed)?;
    match format {
        Format::Text => Ok(diff.to_text()),
        Format::Json => Ok(serde_json::to_string_pretty(&diff)? + "\n"),
        Format::Html => Ok(diff.to_html(&before.to_string_lossy(), &after.to_string_lossy())),
        Format::Dot | Format::Mermaid | Format::Trace => {
            Err(usage("--diff: unsupported format; expected one of: text, json, html"))
        }
    }
}

fn read(file: &Path) -> Result<Dump, Failure> {
    let failed = |problem: String| Failure {
        code: Failure::INPUT,
        message: format!("--diff {}: {problem}", file.display()),
    };
    let text = std::fs::read_to_string(file).map_err(|error| failed(format!("cannot be read: {error}")))?;
    let dump = Dump::from_json(&text)
        .map_err(|error| failed(format!("{error}; `dump -o frame.json` writes one")))?;
    let values = values_file(file);
    if !dump.has_contents() || !values.is_file() {
        return Ok(dump);
    }
    let values = std::fs::read(&values)
        .map_err(|error| failed(format!("{} cannot be read: {error}", values.display())))?;
    dump.with_values(values).map_err(|error| failed(error.to_string()))
}

fn usage(message: &str) -> Failure {
    Failure { code: Failure::USAGE, message: message.into() }
}

/// `shadowgraph explain`
pub(crate) fn explain(args: &ExplainArgs, registry: &Registry) -> Result<(), Failure> {
    let input = input(&args.draw, registry)?;
    let pipeline = input.options.render_config().pipeline;
    let (gpu, Planned { plan, mut times, .. }) = planned(&args.draw, args.frames, input)?;
    let explanation = match &args.before {
        Some(after) => inspect::explain_order(&plan, &args.name, after),
        None => inspect::explain(&plan, &args.name),
    };
    console::print(&explanation.map_err(|error| match pipeline.is_disabled(&args.name) {
        true => Failure { code: Failure::INPUT, message: disabled(&args.name, &pipeline) },
        false => error.into(),
    })?)?;
    let names = [Some(&args.name), args.before.as_ref()];
    let matches = |pass: &str, name: &str| pass == name || pass.rsplit('/').next() == Some(name);
    times.retain(|time| names.iter().flatten().any(|name| matches(&time.pass, name)));
    if times.is_empty() {
        Ok(())
    } else {
        console::print(&format!("\n{}", report::times(&times, &gpu.adapter)))
    }
}

fn disabled(node: &str, pipeline: &Pipeline) -> String {
    let name = pipeline.name();
    format!("the node `{node}` of {name} is disabled: its condition `when` is false; see --set")
}

/// Plans the last of some frames. That needs no GPU, unless times or an adapter are requested.
fn planned(args: &DrawArgs, frames: FramesArgs, input: Input) -> Result<(Gpu, Planned), Failure> {
    if input.options.timings {
        let gpu = Gpu::open(&input.options.adapter).map_err(Failure::no_device)?;
        let (RenderedFrame { plan, times, unshadowed, counts, .. }, _) =
            draw_frames(&gpu, input, frames, &mut |_, _| Ok(()))?;
        return Ok((gpu, Planned { plan, times, unshadowed, counts }));
    }
    let gpu = if args.names_adapter() {
        Gpu::open(&input.options.adapter).map_err(Failure::no_device)?
    } else {
        Gpu::noop()?
    };
    let drawing = Progress::if_slow("drawing");
    let (mut renderer, view) = play(&gpu, input, frames, &drawing, &mut |_, _| Ok(()))?;
    renderer.begin_frame(&gpu, &view)?;
    let (plan, unshadowed) = renderer.plan(&view)?;
    Ok((gpu, Planned { plan, times: Vec::new(), unshadowed, counts: Default::default() }))
}
