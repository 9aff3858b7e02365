//! What outlives a frame.

mod plans;

pub use plans::PlanCounts;

use crate::compiled::Compiled;
use crate::declaration::Declaration;
use crate::desc::ResourceDesc;
use crate::error::Error;
use crate::frame::{Frame, Storage};
use crate::handle::{NodeId, ResourceId};
use crate::history::{PriorHistory, Resize};
use plans::Plans;
use std::sync::{Arc, Mutex, PoisonError};

/// What outlives a frame: plans, the memory that frames are declared in, and for one device the physical textures
/// and buffers, their views and bind groups, and histories.
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
}

type Spare = Arc<Mutex<Vec<Storage>>>;

impl Graph {
    /// Creates an empty graph.
    pub fn new() -> Self {
        Self::default()
    }

    /// Starts a frame in the memory of frames before it.
    pub fn frame<'f>(&self) -> Frame<'f> {
        Frame::with(PriorState {
            spare: Some(self.spare.clone()),
            #[cfg(feature = "gpu")]
            histories: Some(self.device.histories.prior()),
            #[cfg(not(feature = "gpu"))]
            histories: None,
        })
    }

    /// Compiles a frame, or finds the plan of an equal one among the last few. Equal means equal in all that was
    /// declared: names, shapes, accesses, parts, clear values. Where only sizes differ, the order of the passes is
    /// chosen anew but their dependencies are not looked for again.
    ///
    /// # Errors
    /// The first mistake made while declaring, in order of declaration.
    pub fn compile<'f>(&mut self, mut frame: Frame<'f>) -> Result<Compiled<'f>, Error> {
        frame.check()?;
        let plan = self.plans.plan(&mut frame.decl)?;
        Ok(Compiled::new(plan, frame))
    }

    /// Sets how long and how much the graph keeps beyond what a frame needs.
    #[cfg(feature = "gpu")]
    pub fn set_limits(&mut self, limits: crate::pool::PoolLimits) {
        self.device.limits = limits;
    }

    /// Switches a debug mode on or off; off at first. While it is on, a transient texture or buffer is filled with a
    /// loud value before the first pass that touches it, and so is an attachment of which a pass covers all or of
    /// which nothing needs the rest. A read of what no pass has written, such as after a false [`Contents::Overwrite`],
    /// then shows at once, while a frame that is right draws the same as without.
    ///
    /// The values: not a number for floats, the largest for unsigned and -1 for signed integers, magenta (0.93, 0.07,
    /// 0.93, 0.53) for other colours, 0.53 for depth, 0xcd for stencil, and 0x7fcdcdcd in each word of a buffer.
    /// Imports and histories are left alone. It costs a pass or copy for every resource and needs more usages, so
    /// textures and buffers are made anew when it changes.
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

    /// Returns the bytes of all transient textures and buffers and all histories that the graph holds, without the
    /// driver's padding.
    #[cfg(feature = "gpu")]
    pub fn bytes(&self) -> u64 {
        self.device.bytes()
    }

    /// Returns how plans were come by since the graph was created.
    pub fn plan_counts(&self) -> PlanCounts {
        self.plans.counts
    }
}

/// What a frame knows of the graph that gave it out.
#[derive(Clone, Default)]
pub(crate) struct PriorState {
    spare: Option<Spare>,
    histories: Option<Arc<Vec<PriorHistory>>>,
}

impl PriorState {
    pub(crate) fn take_storage(&mut self) -> Storage {
        let spare = self.spare.as_ref();
        let taken = spare.and_then(|spare| spare.lock().unwrap_or_else(PoisonError::into_inner).pop());
        taken.unwrap_or_default()
    }

    /// Gives the memory of a frame back to its graph.
    pub(crate) fn give_back(&self, storage: Storage) {
        if let Some(spare) = &self.spare {
            spare.lock().unwrap_or_else(PoisonError::into_inner).push(storage);
        }
    }

    pub(crate) fn history_valid(
        &self,
        decl: &Declaration,
        view: Option<NodeId>,
        current: ResourceId,
        resize: Resize,
    ) -> bool {
        let ResourceDesc::Texture(desc) = decl.resource(current).desc else { return false };
        self.histories
            .iter()
            .flat_map(|all| all.iter())
            .any(|known| known.matches(decl, view, current) && known.fits(&desc, resize))
    }
}
