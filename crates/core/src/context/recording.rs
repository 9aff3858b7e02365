//! State that the passes of a frame share while they are recorded.

use crate::error::Error;
use crate::handle::{PassId, ResourceId};
use crate::pass_name::{PassName, SourceLocations};
use crate::plan::Plan;
use crate::pool::{PhysicalResource, Pool, ResolvedPlan};
use crate::shader_pass::ShaderPasses;
use crate::timer::Timer;

/// State that all passes of a frame share while they are recorded.
pub(crate) struct Recording<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) frame: u64,
    /// The places of the frame's passes, which can be others than those of the plan.
    pub(crate) places: &'a SourceLocations,
    pub(crate) resolved: &'a ResolvedPlan,
    pub(crate) pool: &'a Pool,
    pub(crate) device: &'a wgpu::Device,
    pub(crate) uniforms: Option<&'a wgpu::Buffer>,
    pub(crate) uploads: &'a Uploads,
    pub(crate) timer: Option<&'a Timer>,
    pub(crate) shader_passes: &'a ShaderPasses,
    /// Bind groups that the device supports.
    pub(crate) max_bind_groups: u32,
}

/// The staged uploads of a frame, all in one buffer, from which they are copied in the order of the plan. Copying with the
/// encoder instead of the queue keeps frames independent that are recorded before any is submitted.
#[derive(Default)]
pub(crate) struct Uploads {
    pub(crate) buffer: Option<wgpu::Buffer>,
    /// Offset of each upload in bytes.
    pub(crate) offsets: Vec<u64>,
}

impl<'a> Recording<'a> {
    pub(crate) fn texture(&self, id: ResourceId) -> Result<&'a wgpu::Texture, Error> {
        match &self.resolved.objects[id.index()] {
            Some(PhysicalResource::Texture(texture)) => Ok(texture),
            _ => Err(self.missing_import(id)),
        }
    }

    pub(crate) fn buffer(&self, id: ResourceId) -> Result<&'a wgpu::Buffer, Error> {
        match &self.resolved.objects[id.index()] {
            Some(PhysicalResource::Buffer(buffer)) => Ok(buffer),
            _ => Err(self.missing_import(id)),
        }
    }

    /// Returns a pass for an error.
    pub(crate) fn pass_name(&self, pass: PassId) -> PassName {
        self.plan.decl.pass_name_at(pass, self.places)
    }

    /// Returns the error of a resource without an object, which only an import can be.
    pub(crate) fn missing_import(&self, id: ResourceId) -> Error {
        Error::NoImport { resource: self.plan.decl.resource_path(id) }
    }
}
