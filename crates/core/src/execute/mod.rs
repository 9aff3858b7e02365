//! Recording a plan into the caller's encoders.

mod attachments;
mod capture;
mod checked;
mod copies;
mod import;
mod poison;
mod record;
mod render;
mod request;
mod shader_pass;
mod stepwise;
mod threads;
mod values;
mod visit;
mod watch;

#[cfg(test)]
mod tests;

pub use capture::{FrameCapture, PendingCapture};
pub use checked::FailedFrame;
pub use request::ReadBackRequest;
pub use values::PendingValues;
pub use watch::PendingTexture;

use crate::compiled::Compiled;
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::{BufferExport, ResourceId, TextureExport, Version};
use crate::plan::Plan;
use crate::pool::PhysicalResource;
use crate::read_back::ReadBack;
use crate::timer::Timer;
use std::sync::Arc;

/// An executed frame: its plan and its exports.
pub struct Executed {
    plan: Arc<Plan>,
    frame: u64,
    exports: Vec<(ResourceId, PhysicalResource)>,
    /// Results by request; `None` once taken.
    read_backs: Vec<Option<ReadBack>>,
    /// The check of values, if the graph has one; `None` once taken.
    values: Option<PendingValues>,
    /// The watched texture, if the graph watches one; `None` once taken.
    watched: Option<PendingTexture>,
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

    /// Takes the check of values of the frame, if [the graph checks them](Graph::check_values); `None` if it was taken before.
    pub fn take_values(&mut self) -> Option<PendingValues> {
        self.values.take()
    }

    /// Takes the texture that [the graph watches](Graph::watch); `None` if the frame has no such version, or it was taken before.
    pub fn take_watched(&mut self) -> Option<PendingTexture> {
        self.watched.take()
    }

    fn export(&self, version: Version) -> Option<&PhysicalResource> {
        let same_frame = version.frame == self.frame;
        let export = self.exports.iter().find(|(id, _)| same_frame && *id == version.resource);
        export.map(|(_, object)| object)
    }
}

impl Graph {
    /// Returns whether passes are recorded one after the other, with something in between.
    fn records_in_order(&self) -> bool {
        self.value_check.is_some() || self.watch.is_some()
    }

    fn record(
        &mut self,
        compiled: Compiled<'_>,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        timer: Option<&mut Timer>,
    ) -> Result<Executed, Error> {
        match (&self.value_check, &self.watch) {
            (Some(check), _) => {
                let graph = (&mut self.device, &mut self.value_pipelines);
                values::record_checked(compiled, graph, check, (device, encoder), timer)
            }
            (None, Some(watch)) => {
                let graph = (&mut self.device, &mut self.watched_plan);
                watch::record_watched(compiled, graph, watch, (device, encoder), timer)
            }
            (None, None) => record::record(compiled, &mut self.device, device, encoder, timer, None),
        }
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
        graph.record(self, device, encoder, None)
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
        graph.record(self, device, encoder, Some(timer))
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
        if graph.records_in_order() {
            let mut encoder = device.create_command_encoder(&Default::default());
            let executed = self.execute(graph, device, &mut encoder)?;
            return Ok((executed, vec![encoder.finish()]));
        }
        let pool = &mut graph.device;
        threads::record(self, pool, device, threads).map_err(|error| pool.classify_error(device, error))
    }
}
