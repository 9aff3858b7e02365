//! Measuring the time of each pass.

use crate::declaration::PassKind;
use crate::error::Error;
use crate::handle::PassId;
use crate::plan::Plan;
use crate::read_back::ReadBack;
use crate::times::PassTime;
use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};
use web_time::Instant;

/// Measures every pass of one frame: CPU time of recording, and GPU time where the device has timestamps.
///
/// Pass it to [`Compiled::execute_timed`](crate::Compiled::execute_timed), submit, then [`read`](Self::read), which waits for
/// the GPU where the times are not [ready](Self::is_ready).
///
/// GPU times require a device with `TIMESTAMP_QUERY` (for copy and encoder passes also
/// `TIMESTAMP_QUERY_INSIDE_ENCODERS`), a frame of at most 2,048 passes, and a submitted encoder.
///
/// Passes that were merged into one render pass are measured separately if the device supports timestamps inside passes;
/// otherwise they share one time, and [`PassTime::shared_by`] is their number. Tile-based GPUs and software drivers run a
/// render pass as a whole, so timestamps inside it mean nothing there: request `TIMESTAMP_QUERY_INSIDE_PASSES` on discrete
/// GPUs only.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Graph, TextureDesc, Timer};
/// # use shadowgraph_core::wgpu;
/// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
/// let (mut graph, mut timer) = (Graph::new(), Timer::new());
/// let mut frame = graph.frame();
/// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
/// frame.render_pass("draw").color(&mut color, Contents::clear_color([0.0; 4]));
/// frame.export_texture(&color);
/// let mut encoder = device.create_command_encoder(&Default::default());
/// graph.compile(frame)?.execute_timed(&mut graph, &device, &mut encoder, &mut timer)?;
/// queue.submit([encoder.finish()]);
/// for time in timer.read(&device, &queue)? {
///     println!("{} {:.3} ms, {:?} ms on the GPU", time.pass, time.cpu_ms, time.gpu_ms);
/// }
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
#[derive(Default)]
pub struct Timer {
    plan: Option<Arc<Plan>>,
    passes: Vec<PassId>,
    /// Index in `passes` of each pass, and how many passes share its render pass.
    positions: Vec<(u32, u32)>,
    begun: Option<Instant>,
    /// Start of the body by position, in nanoseconds since `begun`, and its duration.
    cpu: Vec<(AtomicU64, AtomicU64)>,
    /// Draw calls that bodies reported, by position.
    draws: Vec<AtomicU32>,
    gpu: Option<TimestampQueries>,
    triangles: Option<TriangleQueries>,
}

struct TimestampQueries {
    set: wgpu::QuerySet,
    results: QueryResults,
    /// Copy and encoder passes can be measured.
    inside_encoders: bool,
    /// Merged passes can be measured separately.
    inside_passes: bool,
}

/// The results of a query set: one number for each query.
struct QueryResults {
    resolved: wgpu::Buffer,
    read_back: Option<ReadBack>,
}

/// Counts of triangles by pass.
struct TriangleQueries {
    set: wgpu::QuerySet,
    results: QueryResults,
}

impl Timer {
    /// Creates a timer for one frame.
    pub fn new() -> Self {
        Self::default()
    }

    pub(crate) fn begin(&mut self, device: &wgpu::Device, plan: &Arc<Plan>) {
        self.plan = Some(plan.clone());
        self.passes = plan.order().to_vec();
        self.positions = vec![(0, 1); plan.pass_count()];
        let mut position = 0;
        for step in plan.steps() {
            for &pass in step.passes {
                self.positions[pass.index()] = (position, step.passes.len() as u32);
                position += 1;
            }
        }
        self.begun = Some(Instant::now());
        self.cpu = self.passes.iter().map(|_| Default::default()).collect();
        self.draws = self.passes.iter().map(|_| AtomicU32::new(0)).collect();
        let count = position * 2;
        let supported = device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
        self.gpu = (supported && count > 0 && count <= wgpu::QUERY_SET_MAX_QUERIES)
            .then(|| TimestampQueries::new(device, count));
        let supported = device.features().contains(wgpu::Features::PIPELINE_STATISTICS_QUERY);
        self.triangles = (supported && position > 0 && position <= wgpu::QUERY_SET_MAX_QUERIES)
            .then(|| TriangleQueries::new(device, position));
    }

    pub(crate) fn end(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), Error> {
        let count = self.passes.len() as u32;
        if let Some(gpu) = &mut self.gpu {
            gpu.results.resolve(device, encoder, &gpu.set, count * 2)?;
        }
        if let Some(triangles) = &mut self.triangles {
            triangles.results.resolve(device, encoder, &triangles.set, count)?;
        }
        Ok(())
    }

    pub(crate) fn draws(&self, pass: PassId, draws: u32) {
        let (position, _) = self.positions[pass.index()];
        self.draws[position as usize].fetch_add(draws, Ordering::Relaxed);
    }

    /// Returns the query set that counts a render pass's triangles, and the index of the query.
    pub(crate) fn triangle_query(&self, pass: PassId) -> Option<(&wgpu::QuerySet, u32)> {
        Some((&self.triangles.as_ref()?.set, self.positions[pass.index()].0))
    }

    pub(crate) fn cpu(&self, pass: PassId, begin: Instant) {
        let (position, _) = self.positions[pass.index()];
        let (begin_ns, duration_ns) = &self.cpu[position as usize];
        duration_ns.store(begin.elapsed().as_nanos() as u64, Ordering::Relaxed);
        let since = self.begun.map(|begun| begin.duration_since(begun)).unwrap_or_default();
        begin_ns.store(since.as_nanos() as u64, Ordering::Relaxed);
    }

    /// Returns the query set and the two queries around the render or compute pass that passes from `first` to `last` share;
    /// `None` if each pass has separate queries inside.
    pub(crate) fn step_queries(&self, first: PassId, last: PassId) -> Option<(&wgpu::QuerySet, u32, u32)> {
        let gpu = self.gpu.as_ref().filter(|gpu| first == last || !gpu.inside_passes)?;
        let position = |pass: PassId| self.positions[pass.index()].0;
        Some((&gpu.set, position(first) * 2, position(last) * 2 + 1))
    }

    /// Returns the query set and the first of the two queries of a pass that shares a render pass with others.
    pub(crate) fn inside_queries(&self, pass: PassId, several: bool) -> Option<(&wgpu::QuerySet, u32)> {
        let gpu = self.gpu.as_ref().filter(|gpu| several && gpu.inside_passes)?;
        Some((&gpu.set, self.positions[pass.index()].0 * 2))
    }

    pub(crate) fn encoder_queries(&self, pass: PassId) -> Option<(&wgpu::QuerySet, u32)> {
        let gpu = self.gpu.as_ref().filter(|gpu| gpu.inside_encoders)?;
        Some((&gpu.set, self.positions[pass.index()].0 * 2))
    }

    /// Returns the two queries of the pass at a position, and how many passes they measure.
    fn queries_at(&self, position: usize, plan: &Plan) -> (usize, usize, u32) {
        let separate = (position * 2, position * 2 + 1, 1);
        let (_, together) = self.positions[self.passes[position].index()];
        if together == 1 || self.gpu.as_ref().is_none_or(|gpu| gpu.inside_passes) {
            return separate;
        }
        let within = |&&(start, end): &&(u32, u32)| (start as usize..end as usize).contains(&position);
        let step = plan.steps.iter().find(within);
        step.map_or(separate, |&(start, end)| (start as usize * 2, end as usize * 2 - 1, together))
    }

    /// Returns whether the times of the submitted frame have arrived, so that [`read`](Self::read) does not wait. They arrive while the
    /// device is polled or something else is submitted; in a browser, between two calls from its event loop.
    pub fn is_ready(&self) -> bool {
        let gpu = self.gpu.iter().map(|gpu| &gpu.results);
        let mut results = gpu.chain(self.triangles.iter().map(|triangles| &triangles.results));
        results.all(|results| results.read_back.as_ref().is_none_or(ReadBack::is_ready))
    }

    /// Waits for the submitted frame and returns the times, in order of recording. They are empty if no frame was recorded
    /// with this timer since the last call. Browsers cannot wait: ask [`is_ready`](Self::is_ready) there.
    ///
    /// # Errors
    /// When the device is lost or the times cannot be mapped.
    pub fn read(&mut self, device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Vec<PassTime>, Error> {
        let Some(plan) = self.plan.take() else { return Ok(Vec::new()) };
        let ticks = self.gpu.as_mut().map(|gpu| gpu.results.read(device)).transpose()?;
        let triangles = self.triangles.as_mut().map(|queries| queries.results.read(device)).transpose()?;
        let period = f64::from(queue.get_timestamp_period());
        let gpu_ms = |begin: usize, end: usize| {
            let ticks = ticks.as_ref()?;
            let (begin, end) = (*ticks.get(begin)?, *ticks.get(end)?);
            (end >= begin && begin != 0).then(|| (end - begin) as f64 * period * 1e-6)
        };
        let first = ticks.iter().flatten().copied().filter(|&tick| tick != 0).min();
        let gpu_ms_since_first =
            |query: usize| Some(ticks.as_ref()?.get(query)?.checked_sub(first?)? as f64 * period * 1e-6);
        let times = self.passes.iter().zip(&self.cpu).enumerate().map(|(position, (&pass, cpu))| {
            let (begin, end, shared_by) = self.queries_at(position, &plan);
            let renders = plan.pass(pass).kind == PassKind::Render;
            let draws = self.draws[position].load(Ordering::Relaxed);
            PassTime {
                pass: plan.pass_path(pass),
                node: plan.pass(pass).node.map(|node| plan.node_path(node)).unwrap_or_default(),
                cpu_begin_ms: cpu.0.load(Ordering::Relaxed) as f64 * 1e-6,
                cpu_ms: cpu.1.load(Ordering::Relaxed) as f64 * 1e-6,
                gpu_begin_ms: gpu_ms(begin, end).and(gpu_ms_since_first(begin)),
                gpu_ms: gpu_ms(begin, end),
                shared_by,
                draws: (draws > 0).then_some(draws),
                triangles: triangles.as_ref().filter(|_| renders).and_then(|all| all.get(position).copied()),
            }
        });
        Ok(times.collect())
    }
}

impl TimestampQueries {
    fn new(device: &wgpu::Device, count: u32) -> Self {
        Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count,
            }),
            results: QueryResults::new(device, count),
            inside_encoders: device.features().contains(wgpu::Features::TIMESTAMP_QUERY_INSIDE_ENCODERS),
            inside_passes: device.features().contains(wgpu::Features::TIMESTAMP_QUERY_INSIDE_PASSES),
        }
    }
}

impl TriangleQueries {
    fn new(device: &wgpu::Device, count: u32) -> Self {
        Self {
            set: device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("triangles"),
                ty: wgpu::QueryType::PipelineStatistics(wgpu::PipelineStatisticsTypes::CLIPPER_INVOCATIONS),
                count,
            }),
            results: QueryResults::new(device, count),
        }
    }
}

impl QueryResults {
    fn new(device: &wgpu::Device, count: u32) -> Self {
        let resolved = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("queries"),
            size: u64::from(count) * 8,
            usage: wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            mapped_at_creation: false,
        });
        Self { resolved, read_back: None }
    }

    fn resolve(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        set: &wgpu::QuerySet,
        count: u32,
    ) -> Result<(), Error> {
        encoder.resolve_query_set(set, 0..count, &self.resolved, 0);
        let all = 0..self.resolved.size();
        self.read_back = Some(ReadBack::buffer(device, encoder, "queries", &self.resolved, all)?);
        Ok(())
    }

    fn read(&mut self, device: &wgpu::Device) -> Result<Vec<u64>, Error> {
        let Some(read_back) = self.read_back.take() else { return Ok(Vec::new()) };
        let bytes = read_back.wait(device)?;
        Ok(bytes.as_chunks().0.iter().map(|&number| u64::from_le_bytes(number)).collect())
    }
}
