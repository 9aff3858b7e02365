//! Pipelines: nodes wired together, as a file or as a script of one call per step.
//!
//! A pipeline file names nodes of [`Nodes`](crate::nodes::Nodes) and which output feeds which input ([`Pipeline::load`]). A
//! pipeline in Rust is a [`Wiring`], such as [`Forward`]: copy one and edit it. Both give the same plans.

mod choice;
mod debug_cascades;
mod deferred;
mod file;
mod forward;
mod forward_plus;
mod minimal;
mod view;

pub use choice::{BUILT_IN, Pipeline};
pub use debug_cascades::DebugCascades;
pub use deferred::Deferred;
use file::PipelineFile;
pub use file::{Choices, PipelineError, schema};
pub use forward::Forward;
pub use forward_plus::ForwardPlus;
pub use minimal::Minimal;
pub use view::View;

use shadowgraph_core::{Frame, Texture};
use shadowgraph_lighting::{LitTarget, ViewBuffers};
use shadowgraph_scene::gpu::MaterialLayouts;
use shadowgraph_shadows::{ShadowOutputs, ShadowTechnique};

use crate::Error;

/// What adds all passes of a view to a frame, and keeps what they need from frame to frame.
pub trait Wiring: Send + Sync {
    /// Adds the passes.
    ///
    /// # Errors
    /// For settings out of range, and what a view asks for and cannot be.
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error>;
}

/// What a pipeline is made for.
#[derive(Clone, Copy)]
pub struct Build<'b> {
    /// The device.
    pub device: &'b wgpu::Device,
    /// How materials are bound.
    pub layouts: &'b MaterialLayouts,
    /// How shadows are made.
    pub technique: &'b dyn ShadowTechnique,
    /// What lit passes draw into.
    pub lit: LitTarget,
}

impl Build<'_> {
    /// Refuses several samples a pixel, for a kind of node that reads texels one by one.
    ///
    /// # Errors
    /// [`Error::OneSample`].
    pub fn one_sample(&self, kind: &'static str) -> Result<(), Error> {
        match self.lit.samples {
            1 => Ok(()),
            samples => Err(Error::OneSample { kind, samples }),
        }
    }
}

/// What a pipeline gives.
pub struct Output<'f> {
    /// What is to be seen, as large as the view.
    pub picture: Texture,
    /// What lit passes wrote, for outputs that show it as it is.
    pub light: Option<Texture>,
    /// What the camera sees.
    pub depth: Option<Texture>,
    /// The camera and the lights.
    pub view: Option<ViewBuffers>,
    /// The shadows; empty of a pipeline without.
    pub shadows: ShadowOutputs<'f>,
}

#[cfg(test)]
mod tests;
