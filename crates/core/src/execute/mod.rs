//! Recording a plan into encoders of the caller's.

mod attachments;
mod bind;
mod capture;
mod checked;
mod context;
mod copies;
mod import;
mod last_groups;
mod poison;
mod read_back;
mod realise;
mod record;
mod render;
mod threads;
mod timer;

#[cfg(test)]
mod tests;

pub use bind::Bind;
pub use capture::{FrameCapture, PendingCapture};
pub use checked::FailedFrame;
pub(crate) use context::Body;
pub use context::{BodyResult, ComputeContext, EncoderContext, RenderContext, Resources};
pub(crate) use import::Imported;
pub(crate) use poison::Pattern;
pub(crate) use read_back::Requested;
pub use read_back::{ReadBack, ReadBackRequest};
pub(crate) use realise::Realised;
pub use timer::Timer;

use crate::compiled::Compiled;
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::{BufferExport, ResourceId, TextureExport, Version};
use crate::plan::Plan;
use crate::pool::Physical;
use std::sync::Arc;

/// An executed frame: its plan, and what was exported.
pub struct Executed {
    plan: Arc<Plan>,
    frame: u64,
    exports: Vec<(ResourceId, Physical)>,
    /// By request; `None` once taken.
    read_backs: Vec<Option<ReadBack>>,
}

impl Executed {
    /// The same of another plan of the same frame.
    fn of_plan(self, plan: Arc<Plan>) -> Self {
        Self { plan, ..self }
    }

    /// Returns what was recorded, and why.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the plan, which equal frames share.
    pub fn shared_plan(&self) -> Arc<Plan> {
        self.plan.clone()
    }

    /// Returns an exported texture. It keeps its contents until the graph's next frame is recorded.
    pub fn texture(&self, export: TextureExport) -> Option<&wgpu::Texture> {
        match self.export(export.0)? {
            Physical::Texture(texture) => Some(texture),
            Physical::Buffer(_) => None,
        }
    }

    /// Returns an exported buffer. It keeps its contents until the graph's next frame is recorded.
    pub fn buffer(&self, export: BufferExport) -> Option<&wgpu::Buffer> {
        match self.export(export.0)? {
            Physical::Buffer(buffer) => Some(buffer),
            Physical::Texture(_) => None,
        }
    }

    /// Takes out what was asked to be read back; `None` where it has been taken already, or for the request of
    /// another frame. The bytes come once the encoder has been submitted.
    pub fn read_back(&mut self, request: ReadBackRequest) -> Option<ReadBack> {
        let own = request.frame == self.frame;
        self.read_backs.get_mut(request.index as usize).filter(|_| own)?.take()
    }

    fn export(&self, version: Version) -> Option<&Physical> {
        let own = version.frame == self.frame;
        self.exports.iter().find(|(id, _)| own && *id == version.resource).map(|(_, physical)| physical)
    }
}

impl Compiled<'_> {
    /// Records the frame into `encoder`, with textures and buffers of `graph`. Nothing is submitted.
    ///
    /// # Errors
    /// A limit of the device, or the failure of a pass body; the encoder is then to be dropped. Two that one can go on after,
    /// with other settings or another device: [`Error::OutOfMemory`], and [`Error::DeviceLost`] where that is noticed: wgpu
    /// drops what is recorded for a lost device in silence.
    pub fn execute(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Executed, Error> {
        record::record(self, &mut graph.device, device, encoder, None, None)
    }

    /// Records the frame like [`execute`](Self::execute) and measures every pass; see [`Timer`].
    ///
    /// # Errors
    /// As `execute`.
    pub fn execute_timed(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        timer: &mut Timer,
    ) -> Result<Executed, Error> {
        record::record(self, &mut graph.device, device, encoder, Some(timer), None)
    }

    /// Records the frame on `threads` threads, each into an encoder of its own, and returns the command buffers in
    /// the order in which they must be submitted, best all at once; nothing of another frame of this graph may come in
    /// between.
    ///
    /// Worth it only for frames of very many draws: see `docs/performance.md` for what was measured.
    ///
    /// wgpu's error scopes are each one thread's: what it objects to in a body that another thread records goes to
    /// `Device::on_uncaptured_error`.
    ///
    /// # Errors
    /// As [`execute`](Self::execute).
    pub fn execute_on_threads(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        threads: usize,
    ) -> Result<(Executed, Vec<wgpu::CommandBuffer>), Error> {
        let pool = &mut graph.device;
        threads::record(self, pool, device, threads).map_err(|error| pool.explain(device, error))
    }
}
