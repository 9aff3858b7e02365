//! Recording a plan into the caller's encoders.

mod attachments;
mod capture;
mod checked;
mod copies;
mod import;
mod poison;
mod read_back;
mod record;
mod render;
mod shader_pass;
mod stepwise;
mod threads;

#[cfg(test)]
mod tests;

pub use capture::{FrameCapture, PendingCapture};
pub use checked::FailedFrame;
pub use read_back::{ReadBack, ReadBackRequest};

use crate::compiled::Compiled;
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::{BufferExport, ResourceId, TextureExport, Version};
use crate::plan::Plan;
use crate::pool::PhysicalResource;
use crate::timer::Timer;
use std::sync::Arc;

/// An executed frame: its plan and its exports.
pub struct Executed {
    plan: Arc<Plan>,
    frame: u64,
    exports: Vec<(ResourceId, PhysicalResource)>,
    /// Results by request; `None` once taken.
    read_backs: Vec<Option<ReadBack>>,
}

impl Executed {
    /// Returns the same with another plan of the frame.
    fn with_plan(self, plan: Arc<Plan>) -> Self {
        Self { plan, ..self }
    }

    /// Returns the plan: what was recorded, and why.
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
            PhysicalResource::Texture(texture) => Some(texture),
            PhysicalResource::Buffer(_) => None,
        }
    }

    /// Returns an exported buffer. It keeps its contents until the graph's next frame is recorded.
    pub fn buffer(&self, export: BufferExport) -> Option<&wgpu::Buffer> {
        match self.export(export.0)? {
            PhysicalResource::Buffer(buffer) => Some(buffer),
            PhysicalResource::Texture(_) => None,
        }
    }

    /// Takes the read-back of a request; `None` if it was taken before, or for a request of another frame. The bytes arrive
    /// after the encoder has been submitted.
    pub fn read_back(&mut self, request: ReadBackRequest) -> Option<ReadBack> {
        let same_frame = request.frame == self.frame;
        self.read_backs.get_mut(request.index as usize).filter(|_| same_frame)?.take()
    }

    fn export(&self, version: Version) -> Option<&PhysicalResource> {
        let same_frame = version.frame == self.frame;
        let export = self.exports.iter().find(|(id, _)| same_frame && *id == version.resource);
        export.map(|(_, object)| object)
    }
}

impl Compiled<'_> {
    /// Records the frame into `encoder`, with textures and buffers of `graph`. Nothing is submitted.
    ///
    /// # Errors
    /// A limit of the device, or the failure of a pass body; drop the encoder then. A program can recover from two of them,
    /// with other settings or another device: [`Error::OutOfMemory`], and [`Error::DeviceLost`] where it is detected: wgpu
    /// silently drops commands for a lost device.
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

    /// Records the frame on `threads` threads, each into a separate encoder, and returns the command buffers in the order
    /// in which they must be submitted, preferably all at once; no command of another frame of this graph may come in
    /// between.
    ///
    /// Worthwhile only for frames of very many draws: `docs/performance.md` has measurements.
    ///
    /// wgpu's error scopes belong to one thread: validation errors in a body that another thread records go to
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
        threads::record(self, pool, device, threads).map_err(|error| pool.classify_error(device, error))
    }
}
