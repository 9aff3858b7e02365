//! `gbuffer`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::GBufferPass;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct GBuffer {
    pass: GBufferPass,
}

impl Node for GBuffer {
    const NAME: &'static str = "gbuffer";
    const ABOUT: &'static str = "draws colours, materials and normals of what is seen, for `deferred`";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "that of `geometry`").of(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] = &[Port::new("gbuffer", PortKind::GBuffer, "what was drawn")];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: GBufferPass::new(build.device, build.layouts)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let buffers = ports.view("view")?;
        let gbuffer = self.pass.add_to(frame, &buffers, &ports.texture("depth")?, view.geometry());
        ports.set("gbuffer", gbuffer);
        Ok(())
    }
}
