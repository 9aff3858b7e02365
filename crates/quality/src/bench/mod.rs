//! Cost of a frame: the graph compared with the same passes written by hand, the time of each pass, and that of whole frames.
//!
//! Both sides draw the same view of the same scene with the same pipelines into the same target. Culling and sorting for
//! the camera is done once and not measured. Both sides plan the shadows (fit their views, cull their casters) with the
//! same code; the hand-written side measures it, and
//! [`Comparison::ratio_without_planning`] subtracts it.

mod hand_written;
mod many;
mod moving;
mod objects;
mod stats;
mod whole;

#[cfg(test)]
mod tests;

pub use many::{MATERIALS, ManyFrames, flying_frames, frames_of_many};
pub use moving::{INSTANCES, MovingFrameTime, MovingFrames, moving_frames};
pub use stats::Stats;
pub use whole::{WholeFrame, warm_up, whole_frames, whole_frames_in_turn};

use std::time::{Duration, Instant};

use shadowgraph_core::{Format, Graph, PassTime, TimeHistory, TimeSummary, Timer};

use self::hand_written::HandWritten;
use shadowgraph::RenderView;
use shadowgraph::options::Aov;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// Format of the target, that of a typical window surface.
const TARGET_FORMAT: Format = Format::Bgra8UnormSrgb;

/// CPU time of the steps of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime {
    /// Planning the shadows, and the uniforms of camera and lights. Hand-written frames only: the graph's nodes do it
    /// during declaration.
    pub plan: Duration,
    /// Declaring passes and resources, shadow planning included. The graph only.
    pub declare: Duration,
    /// Compiling the plan, or looking it up: the frames of a comparison are equal, so only the first, which is not
    /// measured, compiles one. The graph only.
    pub compile: Duration,
    /// Recording all passes; in hand-written frames also writing the buffers.
    pub record: Duration,
    /// Finishing the encoder.
    pub finish: Duration,
    /// Submitting.
    pub submit: Duration,
}

impl FrameTime {
    /// Returns the time of the whole frame.
    pub fn total(&self) -> Duration {
        self.plan + self.declare + self.compile + self.record + self.finish + self.submit
    }
}

/// Contents of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Render passes of the encoder: passes of a frame that are merged count as one.
    pub passes: usize,
    /// Buffers written from the CPU.
    pub uploads: usize,
    /// Draw calls.
    pub draws: usize,
}

/// CPU cost of both kinds of frames. The lists have the same length.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Contents of each frame, counted in the hand-written one.
    pub counts: Counts,
    /// Frames through the graph.
    pub graph: Vec<FrameTime>,
    /// Hand-written frames, each directly before or after that of the graph.
    pub hand_written: Vec<FrameTime>,
}

impl Comparison {
    /// Returns the time of the graph divided by that of the hand-written frame, per pair.
    pub fn ratio(&self) -> Stats {
        self.ratio_less(|_| Duration::ZERO)
    }

    /// Returns the same ratio with the planning of shadows subtracted from both sides.
    pub fn ratio_without_planning(&self) -> Stats {
        self.ratio_less(|hand_written| hand_written.plan)
    }

    fn ratio_less(&self, deduction: impl Fn(&FrameTime) -> Duration) -> Stats {
        let less = |time: &FrameTime, hand_written| {
            time.total().saturating_sub(deduction(hand_written)).as_secs_f64()
        };
        let ratio = |(graph, hand_written)| {
            less(graph, hand_written) / less(hand_written, hand_written).max(f64::MIN_POSITIVE)
        };
        Stats::from_samples(self.graph.iter().zip(&self.hand_written).map(ratio))
    }
}

/// Measures `pairs` frames through the graph and as many hand-written ones, after a tenth as many to warm up. The order
/// within a pair alternates. Times are CPU times, best measured on [`Gpu::noop`].
///
/// # Errors
/// Settings out of range, a target over the device's limits, or an output that is not `Aov::Color`.
pub fn compare(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    pairs: u32,
) -> Result<Comparison, Error> {
    require_color(renderer)?;
    gpu.checked(|| compare_unchecked(gpu, renderer, &drawing_maps(options), pairs))
}

/// Returns the options with maps that are drawn in every frame: nothing moves, so kept maps would cost nothing.
fn drawing_maps(options: &ViewOptions) -> ViewOptions {
    ViewOptions { shadows: options.shadows.without_cache(), ..options.clone() }
}

fn compare_unchecked(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    pairs: u32,
) -> Result<Comparison, Error> {
    let target = target(&gpu.device, options.size_px)?;
    renderer.begin_frame(gpu, options)?;
    let renderer = &*renderer;
    let view = renderer.view(options, Some(&target));
    let hand_written = HandWritten::new(gpu, renderer, &view, &target)?;
    let mut graph = Graph::new();
    let mut comparison =
        Comparison { counts: hand_written.counts(), graph: Vec::new(), hand_written: Vec::new() };
    for pair in 0..pairs / 10 + 1 + pairs {
        let (graph_time, hand_time) = if pair % 2 == 0 {
            let graph_time = graph_frame(gpu, renderer, &view, &mut graph)?;
            (graph_time, hand_written.frame(gpu)?)
        } else {
            let hand_time = hand_written.frame(gpu)?;
            (graph_frame(gpu, renderer, &view, &mut graph)?, hand_time)
        };
        if pair > pairs / 10 {
            comparison.graph.push(graph_time);
            comparison.hand_written.push(hand_time);
        }
        idle(gpu)?;
    }
    Ok(comparison)
}

/// Draws one frame as `Renderer::record` does, with a clock between its steps.
fn graph_frame(
    gpu: &Gpu,
    renderer: &Renderer,
    view: &RenderView<'_>,
    graph: &mut Graph,
) -> Result<FrameTime, Error> {
    let mut clock = Clock::start();
    let mut frame = graph.frame();
    renderer.add(&mut frame, view)?;
    let declare = clock.lap();
    let compiled = graph.compile(frame)?;
    let compile = clock.lap();
    let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let executed = compiled.execute(graph, &gpu.device, &mut encoder)?;
    let record = clock.lap();
    let commands = encoder.finish();
    let finish = clock.lap();
    gpu.queue.submit([commands]);
    // Releasing the frame's resources counts as time of the graph.
    drop(executed);
    Ok(FrameTime { plan: Duration::ZERO, declare, compile, record, finish, submit: clock.lap() })
}

/// Measures each pass of `frames` frames: the CPU time of recording it, and its GPU time if the device can measure it. Shadow maps are
/// drawn in each frame.
///
/// # Errors
/// As [`compare`], or when the GPU fails.
pub fn pass_times(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    frames: u32,
) -> Result<Vec<TimeSummary>, Error> {
    require_color(renderer)?;
    let options = &drawing_maps(options);
    let target = target(&gpu.device, options.size_px)?;
    let mut frame = || -> Result<Vec<PassTime>, Error> {
        let mut timer = Timer::new();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.record_measured(gpu, &mut encoder, &target, options, &mut timer)?;
        gpu.queue.submit([encoder.finish()]);
        Ok(timer.read(&gpu.device, &gpu.queue)?)
    };
    gpu.checked(|| {
        // Software drivers compile shaders at the first draw.
        frame()?;
        let mut history = TimeHistory::new(frames as usize);
        for _ in 0..frames.max(1) {
            history.add(&frame()?);
        }
        Ok(history.summary())
    })
}

fn require_color(renderer: &Renderer) -> Result<(), Error> {
    if *renderer.aov() == Aov::Color { Ok(()) } else { Err(Error::BenchAov) }
}

fn target(device: &wgpu::Device, [width, height]: [u32; 2]) -> Result<wgpu::Texture, Error> {
    let limit = device.limits().max_texture_dimension_2d;
    if width.max(height) > limit {
        return Err(shadowgraph::Error::ImageSize { width, height, limit }.into());
    }
    Ok(device.create_texture(&wgpu::TextureDescriptor {
        label: Some("target"),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: TARGET_FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    }))
}

/// Lets wgpu release the resources of submitted work, outside the measured time.
fn idle(gpu: &Gpu) -> Result<(), Error> {
    let polled = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    polled.map(|_| ()).map_err(|error| shadowgraph::Error::Gpu(error.to_string()).into())
}

/// Measures consecutive steps.
struct Clock(Instant);

impl Clock {
    fn start() -> Self {
        Self(Instant::now())
    }

    /// Returns the time since the last call.
    fn lap(&mut self) -> Duration {
        let now = Instant::now();
        now - std::mem::replace(&mut self.0, now)
    }
}
