//! The device and configuration for which pipelines and nodes are built.

use shadowgraph_lighting::LitTarget;
use shadowgraph_scene::gpu::MaterialLayouts;
use shadowgraph_shadows::ShadowTechnique;

use crate::error::Error;

/// The device and configuration for which a pipeline and its nodes are built.
#[derive(Clone, Copy)]
pub struct BuildContext<'b> {
    /// The device.
    pub device: &'b wgpu::Device,
    /// Bind group layouts of materials.
    pub layouts: &'b MaterialLayouts,
    /// The shadow technique.
    pub technique: &'b dyn ShadowTechnique,
    /// The target of lit passes.
    pub lit: LitTarget,
}

impl BuildContext<'_> {
    /// Refuses multisampling, for a kind of node that reads texels one by one.
    ///
    /// # Errors
    /// [`Error::SingleSampleOnly`].
    pub fn require_single_sample(&self, kind: &'static str) -> Result<(), Error> {
        match self.lit.samples {
            1 => Ok(()),
            samples => Err(Error::SingleSampleOnly { kind, samples }),
        }
    }
}
