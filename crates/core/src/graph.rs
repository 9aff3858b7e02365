//! The graph: everything that outlives a frame.

mod plans;
#[cfg(feature = "gpu")]
mod warm;

pub use plans::PlanCounts;

use crate::compiled::Compiled;
use crate::error::Error;
use crate::frame::{Frame, PriorState, Spare};
use plans::Plans;

/// Everything that outlives a frame: plans, the memory of declarations, and for one device the physical textures and
/// buffers, their views and bind groups, and histories.
///
/// ```
/// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
/// let mut graph = Graph::new();
/// for _ in 0..3 {
///     let mut frame = graph.frame();
///     let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
///     frame.render_pass("draw").color(&mut color, Contents::clear_color([0.0; 4]));
///     frame.export_texture(&color);
///     let compiled = graph.compile(frame)?;
///     assert_eq!(compiled.plan().order().len(), 1);
/// }
/// assert_eq!(graph.plan_counts().compiled, 1, "equal frames share a plan");
/// # Ok::<(), shadowgraph_core::Error>(())
/// ```
#[derive(Default)]
pub struct Graph {
    spare: Spare,
    plans: Plans,
    #[cfg(feature = "gpu")]
    pub(crate) device: crate::pool::Pool,
    #[cfg(feature = "gpu")]
    pub(crate) value_check: Option<crate::values::ValueCheck>,
    #[cfg(feature = "gpu")]
    pub(crate) value_pipelines: Option<crate::internal::ValueChecks>,
    #[cfg(feature = "gpu")]
    pub(crate) watch: Option<crate::watch::WatchedTexture>,
    #[cfg(feature = "gpu")]
    pub(crate) watched_plan: Option<crate::watch::WatchedPlan>,
}

impl Graph {
    /// Creates an empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a frame that reuses the memory of earlier frames.
    pub fn frame<'f>(&self) -> Frame<'f> {
        Frame::with_prior_state(PriorState {
            spare: Some(self.spare.clone()),
            #[cfg(feature = "gpu")]
            histories: Some(self.device.histories.prior()),
            #[cfg(not(feature = "gpu"))]
            histories: None,
        })
    }

    /// Compiles a frame, or reuses the plan of an equal one among the last few. Frames are equal if all declarations
    /// are: names, descriptions, accesses, subresources, clear values. If only sizes differ, passes are scheduled again but
    /// their dependencies are reused.
    ///
    /// # Errors
    /// The first error of the declaration, in order of declaration.
    pub fn compile<'f>(&mut self, mut frame: Frame<'f>) -> Result<Compiled<'f>, Error> {
        frame.check()?;
        let plan = self.plans.plan(&mut frame.decl)?;
        Ok(Compiled::new(plan, frame))
    }

    /// Sets for how long and how much memory the graph keeps beyond the needs of a frame.
    #[cfg(feature = "gpu")]
    pub fn set_limits(&mut self, limits: crate::pool::PoolLimits) {
        self.device.limits = limits;
    }

    /// Enables or disables a debug mode, which is off by default. It fills transient textures and buffers with a
    /// conspicuous value before the first pass that uses them, and also attachments that a pass overwrites or whose rest
    /// is not needed. A read of contents that no pass has written, such as after a wrong [`Contents::Overwrite`], then shows
    /// at once; a correct frame draws the same as without the mode.
    ///
    /// The values: NaN for floats, the largest value for unsigned and -1 for signed integers, magenta (0.93, 0.07,
    /// 0.93, 0.53) for other colours, 0.53 for depth, 0xcd for stencil, and 0x7fcdcdcd in each word of a buffer.
    /// Imports and histories are not filled. The mode costs a pass or copy for every resource and needs more usages, so
    /// textures and buffers are recreated when it changes.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
    /// # let (device, queue) = wgpu::Device::noop(&Default::default());
    /// let mut graph = Graph::new();
    /// graph.set_poison(cfg!(debug_assertions));
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    /// frame.render_pass("draws too little").color(&mut color, Contents::Overwrite);
    /// frame.export_texture(&color); // magenta, not black
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// # queue.submit([encoder.finish()]);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// [`Contents::Overwrite`]: crate::Contents::Overwrite
    #[cfg(feature = "gpu")]
    pub fn set_poison(&mut self, on: bool) {
        self.device.set_poison(on);
    }

    /// Checks the values that passes write, or no longer does, which is the default. After each pass of a frame that
    /// [`execute`](crate::Compiled::execute) records, the GPU counts texels that are NaN, infinite or outside of a range;
    /// [`Executed::take_values`](crate::Executed::take_values) returns the report: which pass wrote the first of them, where, and what it
    /// read there.
    ///
    /// It costs a lot. Frames are recorded as for a [capture](crate::Compiled::execute_captured), on one thread, with compute passes in between. The image is the same.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc, ValueCheck};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&Default::default());
    /// let mut graph = Graph::new();
    /// graph.check_values(Some(ValueCheck::default().range("color", 0.0..=1e5)));
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut color, Contents::clear_color([0.5; 4]));
    /// frame.export_texture(&color);
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// queue.submit([encoder.finish()]);
    /// if let Some(values) = executed.take_values() {
    ///     print!("{}", values.wait(&device)?.to_text(executed.plan())); // `draw` wrote `color` v1: 3 texels NaN ...
    /// }
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    #[cfg(feature = "gpu")]
    pub fn check_values(&mut self, check: Option<crate::values::ValueCheck>) {
        self.value_check = check;
    }

    /// Watches a version of a texture in all frames from now on, or none, which is the default: frames that
    /// [`execute`](crate::Compiled::execute) records copy it after the pass that writes it, and
    /// [`Executed::take_watched`](crate::Executed::take_watched) returns it. Use it to show a running program's textures.
    ///
    /// The pass is no longer merged with those after it, and stores what it draws; all else is recorded as without. A frame that
    /// does not write the version, or whose texture lacks the mip level or the layer, is recorded as usual, and so is one whose [values are checked](Self::check_values).
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc, WatchedTexture};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&Default::default());
    /// let mut graph = Graph::new();
    /// graph.watch(Some(WatchedTexture::last("color")));
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba16Float));
    /// frame.render_pass("draw").color(&mut color, Contents::clear_color([0.5; 4]));
    /// frame.export_texture(&color);
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// queue.submit([encoder.finish()]);
    /// let watched = executed.take_watched().expect("the frame writes it");
    /// // A program that must not wait asks `watched.is_ready()` after each of its next frames.
    /// let snapshot = watched.wait(&device)?;
    /// assert_eq!(snapshot.full_px, [64, 64]);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    #[cfg(feature = "gpu")]
    pub fn watch(&mut self, watch: Option<crate::watch::WatchedTexture>) {
        self.watch = watch;
    }

    /// Returns the bytes of all transient textures and buffers and all histories that the graph holds, without the
    /// driver's padding.
    #[cfg(feature = "gpu")]
    pub fn bytes(&self) -> u64 {
        self.device.bytes()
    }

    /// Returns how plans were obtained since the graph was created.
    pub fn plan_counts(&self) -> PlanCounts {
        self.plans.counts
    }
}
