//! `forward`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::Forward as ForwardPasses;

use super::velocity::VelocityOutput;
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct Forward {
    passes: ForwardPasses,
    velocity: VelocityOutput,
}

impl Node for Forward {
    const NAME: &'static str = "forward";
    const ABOUT: &'static str = "draws geometry lit by all lights; shadows are looked up per pixel";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "the depth of `geometry`; without it hidden pixels are lit too")
            .with_format(Format::Depth32Float)
            .optional(),
    ];
    const OUTPUTS: &'static [Port] = &[
        Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float),
        Port::texture("depth", "reversed depth").with_format(Format::Depth32Float),
        VelocityOutput::PORT,
    ];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        let passes = ForwardPasses::new(context.device, context.layouts, context.technique, context.lit)?;
        Ok(Self { passes, velocity: VelocityOutput::new(context) })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (geometry, background) = (view.geometry(frame), view.clear_color());
        let (light, depth) = if ports.is_connected("depth") {
            let depth = ports.texture("depth")?;
            (self.passes.lit(frame, &buffers, shadows, &depth, &geometry, background)?, depth)
        } else {
            self.passes.lit_without_prepass(frame, &buffers, shadows, &geometry, background)?
        };
        self.velocity.set(frame, view, (&buffers, &depth), ports)?;
        ports.set("light", light);
        ports.set("depth", depth);
        Ok(())
    }
}
