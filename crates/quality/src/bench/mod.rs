//! What a frame costs: the graph beside the same passes encoded by hand, and the time of each pass.
//!
//! Both sides draw the same view of the same scene with the same pipelines into the same target. In neither is the
//! culling and sorting of what the camera sees, which is done once. In both is the planning of the shadows (fitting
//! their views, culling their casters): it is the same code, the hand-written side measures it, and
//! [`Comparison::ratio_without_planning`] leaves it out.

mod by_hand;
mod objects;
mod stats;

#[cfg(test)]
mod tests;

pub use stats::Stats;

use std::time::{Duration, Instant};

use shadowgraph_core::{Format, Graph, PassTime, TimeHistory, TimeSummary, Timer};

use self::by_hand::ByHand;
use shadowgraph::RenderView;
use shadowgraph::options::Aov;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// What is drawn into, as a window's surface would be.
const TARGET_FORMAT: Format = Format::Bgra8UnormSrgb;

/// CPU time of the steps of one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameTime {
    /// Planning the shadows, with the camera's and the lights' records. By hand only: the graph's nodes do it while
    /// they are declared.
    pub plan: Duration,
    /// Declaring passes and resources, shadow planning included. The graph only.
    pub declare: Duration,
    /// Making the plan, or finding it again: the frames of a comparison are equal, so only the first, which is not
    /// measured, makes one. The graph only.
    pub compile: Duration,
    /// Recording all passes; by hand, writing the buffers too.
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

/// What a frame consists of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Render passes of the encoder: passes of a frame that are merged count as one.
    pub passes: usize,
    /// Buffers written from the CPU.
    pub uploads: usize,
    /// Draw calls.
    pub draws: usize,
}

/// The CPU cost of frames, side by side. The lists are as long as each other.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What each frame consists of, counted where it is encoded by hand.
    pub counts: Counts,
    /// Through the graph.
    pub graph: Vec<FrameTime>,
    /// By hand, each right before or after the one of the graph.
    pub by_hand: Vec<FrameTime>,
}

impl Comparison {
    /// Returns how many times as long as by hand the graph takes, frame by frame.
    pub fn ratio(&self) -> Stats {
        self.ratio_less(|_| Duration::ZERO)
    }

    /// Returns the same with the planning of shadows taken off both sides.
    pub fn ratio_without_planning(&self) -> Stats {
        self.ratio_less(|by_hand| by_hand.plan)
    }

    fn ratio_less(&self, of_both: impl Fn(&FrameTime) -> Duration) -> Stats {
        let less = |time: &FrameTime, by_hand| time.total().saturating_sub(of_both(by_hand)).as_secs_f64();
        let ratio = |(graph, by_hand)| less(graph, by_hand) / less(by_hand, by_hand).max(f64::MIN_POSITIVE);
        Stats::of(self.graph.iter().zip(&self.by_hand).map(ratio))
    }
}

/// Measures `pairs` frames through the graph and as many by hand, after a tenth as many to warm up. Which of a
/// pair is first alternates. The time is that of the CPU: on [`Gpu::noop`] there is no other.
///
/// # Errors
/// Settings out of range, a target over the device's limits, or an output that is not `Aov::Color`.
pub fn compare(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    pairs: u32,
) -> Result<Comparison, Error> {
    only_color(renderer)?;
    gpu.checked(|| compare_unchecked(gpu, renderer, options, pairs))
}

fn compare_unchecked(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    pairs: u32,
) -> Result<Comparison, Error> {
    let target = target(&gpu.device, options.size_px)?;
    renderer.move_origin(gpu, options)?;
    let renderer = &*renderer;
    let view = renderer.view(options, Some(&target));
    let by_hand = ByHand::new(gpu, renderer, &view, &target)?;
    let mut graph = Graph::new();
    let mut comparison = Comparison { counts: by_hand.counts(), graph: Vec::new(), by_hand: Vec::new() };
    for pair in 0..pairs / 10 + 1 + pairs {
        let (through, hand) = if pair % 2 == 0 {
            let through = through_graph(gpu, renderer, &view, &mut graph)?;
            (through, by_hand.frame(gpu)?)
        } else {
            let hand = by_hand.frame(gpu)?;
            (through_graph(gpu, renderer, &view, &mut graph)?, hand)
        };
        if pair > pairs / 10 {
            comparison.graph.push(through);
            comparison.by_hand.push(hand);
        }
        idle(gpu)?;
    }
    Ok(comparison)
}

/// Draws one frame as `Renderer::record` does, with a clock between its steps.
fn through_graph(
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
    // To the graph's account: giving back what a frame is made of.
    drop(executed);
    Ok(FrameTime { plan: Duration::ZERO, declare, compile, record, finish, submit: clock.lap() })
}

/// Measures each pass of `frames` frames: the CPU time of recording it, and its GPU time where the device can tell.
///
/// # Errors
/// As [`compare`], or when the GPU fails.
pub fn pass_times(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    frames: u32,
) -> Result<Vec<TimeSummary>, Error> {
    only_color(renderer)?;
    let target = target(&gpu.device, options.size_px)?;
    let mut frame = || -> Result<Vec<PassTime>, Error> {
        let mut timer = Timer::new();
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        renderer.record_timed(gpu, &mut encoder, &target, options, Some(&mut timer))?;
        gpu.queue.submit([encoder.finish()]);
        Ok(timer.read(&gpu.device, &gpu.queue)?)
    };
    gpu.checked(|| {
        // A software driver compiles shaders at the first draw.
        frame()?;
        let mut history = TimeHistory::new(frames as usize);
        for _ in 0..frames.max(1) {
            history.add(&frame()?);
        }
        Ok(history.summary())
    })
}

fn only_color(renderer: &Renderer) -> Result<(), Error> {
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

/// Lets wgpu give back what submitted work held, outside of what is measured.
fn idle(gpu: &Gpu) -> Result<(), Error> {
    let polled = gpu.device.poll(wgpu::PollType::wait_indefinitely());
    polled.map(|_| ()).map_err(|error| shadowgraph::Error::Gpu(error.to_string()).into())
}

/// Times of one step after the other.
struct Clock(Instant);

impl Clock {
    fn start() -> Self {
        Self(Instant::now())
    }

    /// The time since the last call.
    fn lap(&mut self) -> Duration {
        let now = Instant::now();
        now - std::mem::replace(&mut self.0, now)
    }
}
