//! `gbuffer`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::GBufferPass;

use super::velocity::VelocityOutput;
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct GBuffer {
    pass: GBufferPass,
    velocity: VelocityOutput,
}

impl Node for GBuffer {
    const NAME: &'static str = "gbuffer";
    const ABOUT: &'static str = "draws a G-buffer with colours, materials and normals, for `deferred`";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "the depth of `geometry`").with_format(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::new("gbuffer", PortKind::GBuffer, "colours, materials and normals"), VelocityOutput::PORT];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        let pass = GBufferPass::new(context.device, context.layouts)?;
        Ok(Self { pass, velocity: VelocityOutput::new(context) })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, depth) = (ports.view("view")?, ports.texture("depth")?);
        let geometry = view.geometry(frame);
        let gbuffer = self.pass.add_to(frame, &buffers, &depth, &geometry);
        self.velocity.set(frame, view, (&buffers, &depth), ports)?;
        ports.set("gbuffer", gbuffer);
        Ok(())
    }
}
