//! `shadowgraph bench`: the cost of a frame.

use std::time::{Duration, Instant};

use super::ablate::ablate;
use super::args::BenchArgs;
use super::commands::{self, Input};
use super::console;
use super::failure::Failure;
use super::first_image::first_image;
use super::fly::fly;
use super::progress::Progress;
use super::report::{self, COLUMNS};
use shadowgraph::core::TimeSummary;
use shadowgraph::{Culling, FrameCounts, Gpu, Pipeline, Registry, RenderConfig, Renderer, ViewOptions};
use shadowgraph_quality::TextTable;
use shadowgraph_quality::bench::{
    Comparison, FrameTime, INSTANCES, MATERIALS, ManyFrames, MovingFrameTime, MovingFrames, Stats,
    WholeFrame, compare, frames_of_many, moving_frames, pass_times, whole_frames,
};

/// Number of frames on a real GPU; each is waited for.
const GPU_FRAMES: u32 = 20;

/// Measures and prints, a table at a time.
pub(crate) fn bench(args: &BenchArgs, registry: &Registry) -> Result<(), Failure> {
    let start = Instant::now();
    let input = commands::input(&args.draw.with_default_pipeline(Pipeline::minimal_lit().name()), registry)?;
    let read = start.elapsed();
    let view = commands::tracked(&commands::view_options(&input)?, &input.options, input.options.time.0)?;
    if cfg!(debug_assertions) {
        console::warning("debug build: measure with `cargo run --release`");
    }
    if args.first_image {
        console::print(&heading(args, &input))?;
        return console::print(&first_image(input, &view)?);
    }
    let noop = Gpu::noop()?;
    let gpu = match args.draw.names_adapter() {
        true => Some(Gpu::open(&input.options.adapter).map_err(Failure::no_device)?),
        false => None,
    };
    console::print(&heading(args, &input))?;
    if !args.moving.is_empty() {
        let counts: Vec<usize> = args.moving.iter().map(|&count| count as usize).collect();
        let (gpu, size_px) = (gpu.as_ref().unwrap_or(&noop), view.size_px);
        let measuring = Progress::if_slow("measuring");
        let runs = moving_frames(gpu, &input.options.render_config(), size_px, &counts, args.frames)?;
        drop(measuring);
        return console::print(&moving_table(&runs));
    }
    if !args.boxes.is_empty() {
        let counts: Vec<usize> = args.boxes.iter().map(|&count| count as usize).collect();
        let (gpu, size_px) = (gpu.as_ref().unwrap_or(&noop), view.size_px);
        let measuring = Progress::if_slow("measuring");
        let runs = frames_of_many(gpu, &input.options.render_config(), size_px, &counts, args.frames)?;
        drop(measuring);
        return console::print(&boxes_table(&runs));
    }
    if args.fly {
        let gpu = gpu.as_ref().unwrap_or(&noop);
        return console::print(&fly(gpu, input, &view, args.frames, read)?);
    }
    if args.whole_frame || args.ablate {
        let gpu = gpu.map_or_else(|| Gpu::open(&input.options.adapter).map_err(Failure::no_device), Ok)?;
        let frames = args.frames.min(GPU_FRAMES);
        let measuring = Progress::if_slow("measuring");
        let tables = if args.ablate {
            ablate(&gpu, &input, &view, frames)?
        } else {
            let renderer = &mut input.renderer(&gpu)?;
            let times = whole_frames(&gpu, renderer, &view, frames)?;
            let passes = passes(&gpu, renderer, &view, frames)?;
            let culled = count_tables(&gpu, renderer, &view)?;
            format!("{}\n{passes}{culled}", whole_frame_table(&times, &gpu.adapter.name))
        };
        drop(measuring);
        return console::print(&tables);
    }
    let measuring = Progress::if_slow("measuring");
    let comparison = match hand_written(&input) {
        Some(input) => table(&compare(&noop, &mut input.renderer(&noop)?, &view, args.frames)?),
        None => {
            "Only the pipeline minimal_lit with pcf and one sample has hand-written passes to compare with.\n"
                .into()
        }
    };
    let gpu = gpu.as_ref().unwrap_or(&noop);
    let passes = passes(gpu, &mut input.renderer(gpu)?, &view, args.frames.min(GPU_FRAMES))?;
    drop(measuring);
    console::print(&format!("{comparison}\n{passes}"))
}

/// Returns the input with instances that the CPU culls, if there are hand-written passes for its other options.
fn hand_written(input: &Input) -> Option<Input> {
    let mut input = input.clone();
    input.options.culling = Culling::Cpu;
    let config = RenderConfig { culling: Culling::Cpu, ..RenderConfig::from(Pipeline::minimal_lit()) };
    (input.options.render_config() == config).then_some(input)
}

fn passes(gpu: &Gpu, renderer: &mut Renderer, view: &ViewOptions, frames: u32) -> Result<String, Failure> {
    let times = pass_times(gpu, renderer, view, frames)?;
    let device = &gpu.adapter.name;
    Ok(format!("time of each pass, medians of {frames} frames on {device}\n{}", pass_table(&times)))
}

fn heading(args: &BenchArgs, input: &Input) -> String {
    let has_scene = args.moving.is_empty() && args.boxes.is_empty();
    let scene = if has_scene { args.draw.scene_name() } else { "boxes".into() };
    let (size, pipeline) = (&input.options.size, input.options.pipeline.name());
    let samples = if input.options.samples > 1 { ", 4 samples" } else { "" };
    format!(
        "{scene}, {size}, pipeline {pipeline}, technique {}{samples}\n",
        input.options.render_config().technique().name()
    )
}

/// Returns the time of one or several steps of a frame.
type StepOf = fn(&FrameTime) -> Duration;

/// Formats the comparison as a table.
fn table(comparison: &Comparison) -> String {
    let steps: [(&str, Option<StepOf>, Option<StepOf>); 6] = [
        ("plan shadows", None, Some(|time| time.plan)),
        ("declare (includes planning shadows)", Some(|time| time.declare), None),
        ("compile", Some(|time| time.compile), None),
        ("record", Some(|time| time.record), Some(|time| time.record)),
        ("finish", Some(|time| time.finish), Some(|time| time.finish)),
        ("submit", Some(|time| time.submit), Some(|time| time.submit)),
    ];
    let counts = comparison.counts;
    let heading = format!(
        "CPU time of a frame of {} render passes, {} uploads and {} draws, culled by the CPU; noop device\n",
        counts.passes, counts.uploads, counts.draws
    );
    let count = format!("{} frames each", comparison.graph.len());
    let mut rows = vec![
        [&*count, "graph", "", "hand-written", ""].map(str::to_owned),
        ["microseconds", "median", "p95", "median", "p95"].map(str::to_owned),
    ];
    let whole: (&str, Option<StepOf>, Option<StepOf>) =
        ("whole frame", Some(FrameTime::total), Some(FrameTime::total));
    for (name, graph, hand_written) in steps.into_iter().chain([whole]) {
        let [graph_median, graph_p95] = times(&comparison.graph, graph);
        let [median, p95] = times(&comparison.hand_written, hand_written);
        rows.push([name.into(), graph_median, graph_p95, median, p95]);
    }
    format!(
        "{heading}{}\n  graph / hand-written, per pair: {}\n  without planning shadows:       {}\n  \
         Culling and sorting for the camera is not included.\n",
        TextTable { alignment: "lrrrr", indent: 2, width: COLUMNS }.format(rows),
        ratio(comparison.ratio()),
        ratio(comparison.ratio_without_planning())
    )
}

/// Returns the median and the 95th percentile of a step, microseconds.
fn times(frames: &[FrameTime], step: Option<StepOf>) -> [String; 2] {
    let Some(step) = step else { return ["-".into(), String::new()] };
    let stats = Stats::from_samples(frames.iter().map(|time| step(time).as_secs_f64() * 1e6));
    [stats.median, stats.p95].map(|micros| format!("{micros:.1}"))
}

/// Formats the frames in which instances move as a table.
fn moving_table(runs: &[MovingFrames]) -> String {
    let mut rows = vec![["moving", "edit", "follow", "both, per instance", "draw"].map(str::to_owned)];
    for MovingFrames { moving, frames } in runs {
        let median = |step: fn(&MovingFrameTime) -> Duration| {
            Stats::from_samples(frames.iter().map(|time| step(time).as_secs_f64() * 1e6)).median
        };
        let (edit, follow, draw) =
            (median(|time| time.edit), median(|time| time.follow), median(|time| time.draw));
        let each = if *moving == 0 { "-".into() } else { format!("{:.3}", (edit + follow) / *moving as f64) };
        rows.push([
            moving.to_string(),
            format!("{edit:.1}"),
            format!("{follow:.1}"),
            each,
            format!("{draw:.1}"),
        ]);
    }
    let frames = runs.first().map_or(0, |run| run.frames.len());
    format!(
        "CPU time of a frame of {INSTANCES} boxes, some of which move; medians of {frames} frames, microseconds\n{}",
        TextTable { alignment: "rrrrr", indent: 2, width: COLUMNS }.format(rows)
    )
}

/// Formats the frames of many boxes as a table.
fn boxes_table(runs: &[ManyFrames]) -> String {
    let mut rows = vec![["boxes", "culled by", "median", "95th percentile"].map(str::to_owned)];
    for ManyFrames { boxes, culling, frames } in runs {
        let stats = Stats::from_samples(frames.iter().map(|time| time.as_secs_f64() * 1e3));
        let culling = if *culling == Culling::Gpu { "GPU" } else { "CPU" };
        let [median, high] = [stats.median, stats.p95].map(|ms| format!("{ms:.3}"));
        rows.push([boxes.to_string(), culling.into(), median, high]);
    }
    let frames = runs.first().map_or(0, |run| run.frames.len());
    format!(
        "CPU time of a frame of boxes of {MATERIALS} materials with a moving camera, {frames} frames, milliseconds\n{}",
        TextTable { alignment: "rlrr", indent: 2, width: COLUMNS }.format(rows)
    )
}

/// Formats the times of whole frames as a table.
fn whole_frame_table(frames: &[WholeFrame], device: &str) -> String {
    let row = |name: &str, time: fn(&WholeFrame) -> Duration| {
        let stats = Stats::from_samples(frames.iter().map(|frame| time(frame).as_secs_f64() * 1e3));
        [name.into(), format!("{:.2}", stats.median), format!("{:.2} to {:.2}", stats.p5, stats.p95)]
    };
    let rows = vec![
        ["milliseconds", "median", "5th to 95th percentile"].map(str::to_owned),
        row("until the GPU has finished", |frame| frame.wall),
        row("processor time of the thread", |frame| frame.thread),
    ];
    format!(
        "whole frames, {} on {device}; shadow maps are drawn in each\n{}",
        frames.len(),
        TextTable { alignment: "lrr", indent: 2, width: COLUMNS }.format(rows)
    )
}

/// Formats what the GPU counts in a frame: how many instances the views draw that it culls, and what the shadow technique counts.
fn count_tables(gpu: &Gpu, renderer: &mut Renderer, view: &ViewOptions) -> Result<String, Failure> {
    let counts = renderer.draw(gpu, view)?.counts;
    if counts == FrameCounts::default() {
        return Ok(String::new());
    }
    let all = renderer.casters().scene.instance_count();
    let tables = report::counts(&counts);
    Ok(format!("\ncounted in a frame after the measured ones, of {all} instances\n{tables}"))
}

fn ratio(stats: Stats) -> String {
    let Stats { p5, p25, median, p75, p95 } = stats;
    format!("median {median:.2}, quartiles {p25:.2} to {p75:.2}, 5th to 95th percentile {p5:.2} to {p95:.2}")
}

/// Formats the times of passes as a table. Names include the path of the node.
fn pass_table(passes: &[TimeSummary]) -> String {
    let mut rows = vec![["pass", "CPU us", "GPU ms", ""].map(str::to_owned)];
    let mut row = |name: &str, cpu_ms: f64, gpu_ms: Option<f64>, note: String| {
        let gpu = gpu_ms.map_or("-".into(), |ms| format!("{ms:.3}"));
        rows.push([name.into(), format!("{:.1}", cpu_ms * 1e3), gpu, note]);
    };
    for pass in passes {
        let gpu_ms = pass.gpu_ms.map(|gpu_ms| gpu_ms.median);
        row(&pass.pass, pass.cpu_ms.median, gpu_ms, report::sharing(gpu_ms.is_some(), pass.shared_by));
    }
    let gpu_ms = passes.iter().filter_map(TimeSummary::gpu_share_ms).reduce(|a, b| a + b);
    row("sum", passes.iter().map(|pass| pass.cpu_ms.median).sum(), gpu_ms, String::new());
    TextTable { alignment: "lrrl", indent: 2, width: COLUMNS }.format(rows)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;
    use shadowgraph::core::TimeStats;
    use shadowgraph_quality::bench::Counts;

    fn comparison(micros: u64) -> Comparison {
        let step = Duration::from_micros(micros);
        let none = Duration::ZERO;
        let hand_written =
            FrameTime { plan: step, declare: none, compile: none, record: step, finish: step, submit: step };
        let graph = FrameTime { plan: none, declare: 3 * step, compile: step, ..hand_written };
        let counts = Counts { passes: 5, uploads: 4, draws: 1_000_000 };
        Comparison { counts, graph: vec![graph; 3], hand_written: vec![hand_written; 3] }
    }

    #[test]
    fn the_table_is_at_most_110_columns_wide_and_its_columns_are_aligned() {
        let text = table(&comparison(1_000_000));
        assert!(text.lines().all(|line| line.chars().count() <= 110), "{text}");
        let rows: Vec<_> = text.lines().filter(|line| line.contains("1000000.0")).collect();
        assert_eq!(rows.len(), 5, "{text}");
        assert!(rows.iter().all(|row| row.trim_end().len() == rows[2].len() || row.contains("-")), "{text}");
    }

    #[test]
    fn passes_are_listed_in_order_with_their_sum() {
        let stats = |ms: f64| TimeStats { median: ms, high: ms };
        let pass = |pass: &str, gpu_ms: Option<f64>, shared_by| TimeSummary {
            pass: pass.into(),
            node: String::new(),
            cpu_ms: stats(0.5),
            gpu_ms: gpu_ms.map(stats),
            shared_by,
        };
        let text = pass_table(&[
            pass("shadows/atlas/clear", Some(1.5), 2),
            pass("shadows/atlas/light", Some(1.5), 2),
            pass("output/tonemap", None, 1),
        ]);
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(rows[1], ["shadows/atlas/clear", "500.0", "1.500", "all", "2", "merged"]);
        assert_eq!(rows[2], ["shadows/atlas/light", "500.0", "1.500", "all", "2", "merged"]);
        assert_eq!(rows[3], ["output/tonemap", "500.0", "-"]);
        assert_eq!(rows[4], ["sum", "1500.0", "1.500"]);
        assert!(text.lines().all(|line| line.len() <= 110), "{text}");
    }

    #[test]
    fn whole_frames_have_their_medians() {
        let frame =
            |ms| WholeFrame { wall: Duration::from_millis(ms), thread: Duration::from_millis(ms / 10) };
        let text = whole_frame_table(&[frame(10), frame(30), frame(20)], "a GPU");
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split_whitespace().collect()).collect();
        assert_eq!(rows[0][..3], ["whole", "frames,", "3"]);
        assert_eq!(rows[2][5..], ["20.00", "10.00", "to", "30.00"]);
        assert_eq!(rows[3][5..], ["2.00", "1.00", "to", "3.00"]);
    }

    #[test]
    fn the_ratio_is_printed_with_and_without_planning() {
        let text = table(&comparison(100));
        // 7 steps to 4; without planning 6 to 3.
        assert!(text.contains("per pair: median 1.75"), "{text}");
        assert!(text.contains("shadows:       median 2.00"), "{text}");
        assert!(text.lines().any(|line| line.contains("whole frame") && line.contains("700.0")), "{text}");
    }
}
