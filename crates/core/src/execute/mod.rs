//! Recording a plan into an encoder of the caller's.

mod attachments;
mod context;
mod copies;
mod import;
mod record;
mod timer;

#[cfg(test)]
mod tests;

pub(crate) use context::Body;
pub use context::{Bind, BodyResult, ComputeContext, EncoderContext, RenderContext, Resources};
pub(crate) use import::Imported;
pub use timer::{PassTime, Timer};

use crate::compiled::Compiled;
use crate::error::Error;
use crate::handle::{BufferExport, ResourceId, TextureExport, Version};
use crate::plan::Plan;
use crate::pool::{Physical, Pool};

/// An executed frame: its plan, and what was exported.
pub struct Executed {
    plan: Plan,
    frame: u64,
    exports: Vec<(ResourceId, Physical)>,
}

impl Executed {
    /// Returns what was recorded, and why.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns an exported texture. It keeps its contents until the pool's next frame is recorded.
    pub fn texture(&self, export: TextureExport) -> Option<&wgpu::Texture> {
        match self.export(export.0)? {
            Physical::Texture(texture) => Some(texture),
            Physical::Buffer(_) => None,
        }
    }

    /// Returns an exported buffer. It keeps its contents until the pool's next frame is recorded.
    pub fn buffer(&self, export: BufferExport) -> Option<&wgpu::Buffer> {
        match self.export(export.0)? {
            Physical::Buffer(buffer) => Some(buffer),
            Physical::Texture(_) => None,
        }
    }

    fn export(&self, version: Version) -> Option<&Physical> {
        let own = version.frame == self.frame;
        self.exports.iter().find(|(id, _)| own && *id == version.resource).map(|(_, physical)| physical)
    }
}

impl Compiled<'_> {
    /// Records the frame into `encoder`, with textures and buffers of `pool`. Nothing is submitted.
    ///
    /// # Errors
    /// A limit of the device, or the failure of a pass body; the encoder is then to be dropped.
    pub fn execute(
        self,
        pool: &mut Pool,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Executed, Error> {
        record::record(self, pool, device, encoder, None)
    }

    /// Records the frame like [`execute`](Self::execute) and measures every pass; see [`Timer`].
    ///
    /// # Errors
    /// As `execute`.
    pub fn execute_timed(
        self,
        pool: &mut Pool,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        timer: &mut Timer,
    ) -> Result<Executed, Error> {
        record::record(self, pool, device, encoder, Some(timer))
    }
}
