//! `deferred`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::{Deferred as DeferredPass, Forward};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct Deferred {
    pass: DeferredPass,
    /// Draws blended geometry.
    forward: Forward,
}

impl Node for Deferred {
    const NAME: &'static str = "deferred";
    const ABOUT: &'static str = "lights a G-buffer and draws blended geometry over it";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "the depth of `geometry`").with_format(Format::Depth32Float),
        Port::new("gbuffer", PortKind::GBuffer, "the G-buffer"),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float)];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        let BuildContext { device, layouts, technique, lit } = *context;
        let forward = Forward::new(device, layouts, technique, lit)?;
        Ok(Self { pass: DeferredPass::new(device, technique, lit)?, forward })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (depth, gbuffer) = (ports.texture("depth")?, ports.gbuffer("gbuffer")?);
        let mut light = self.pass.add_to(frame, &buffers, shadows, &depth, &gbuffer, view.clear_color())?;
        let geometry = view.geometry(frame);
        self.forward.blended(frame, &buffers, shadows, &depth, &geometry, &mut light)?;
        ports.set("light", light);
        Ok(())
    }
}
