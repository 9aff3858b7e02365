//! The output `velocity` of nodes that draw depth.

use std::sync::OnceLock;

use shadowgraph_core::{Frame, Texture};
use shadowgraph_lighting::{Velocity, ViewBuffers};
use shadowgraph_scene::gpu::MaterialLayouts;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::render_view::RenderView;

/// The passes that compute motion vectors, created when a frame needs them first.
pub(super) struct VelocityOutput {
    device: wgpu::Device,
    layouts: MaterialLayouts,
    samples: u32,
    passes: OnceLock<Velocity>,
}

impl VelocityOutput {
    const NAME: &'static str = "velocity";

    /// The port; it has no value if nothing reads it.
    pub(super) const PORT: Port = Port::texture(
        Self::NAME,
        "motion back to the previous frame, pixels, y down, without jitter; with one sample per pixel",
    )
    .with_format(Velocity::FORMAT)
    .optional();

    pub(super) fn new(context: &BuildContext<'_>) -> Self {
        let (device, layouts) = (context.device.clone(), context.layouts.clone());
        Self { device, layouts, samples: context.lit.samples, passes: OnceLock::new() }
    }

    /// Adds the passes and sets the output if something reads it. `depth` is the depth that the node has drawn or read.
    pub(super) fn set<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        (buffers, depth): (&ViewBuffers, &Texture),
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        if !ports.is_read(Self::NAME) {
            return Ok(());
        }
        if self.samples != 1 {
            return Err(Error::SingleSampleOnly { kind: Self::NAME, samples: self.samples });
        }
        let passes = match self.passes.get() {
            Some(passes) => passes,
            None => {
                let created = Velocity::new(&self.device, &self.layouts)?;
                self.passes.get_or_init(|| created)
            }
        };
        let geometry = view.geometry(frame);
        let velocity = passes.add_to(frame, buffers, depth, &geometry);
        ports.set(Self::NAME, velocity);
        Ok(())
    }
}
