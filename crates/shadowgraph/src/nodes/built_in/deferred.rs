//! `deferred`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::{Deferred as DeferredPass, Forward};

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Deferred {
    pass: DeferredPass,
    /// For what is blended.
    forward: Forward,
}

impl Node for Deferred {
    const NAME: &'static str = "deferred";
    const ABOUT: &'static str = "lights what a G-buffer holds, and draws what is blended over it";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "that of `geometry`").of(Format::Depth32Float),
        Port::new("gbuffer", PortKind::GBuffer, "that of `gbuffer`"),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float)];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        let Build { device, layouts, technique, lit } = *build;
        let forward = Forward::new(device, layouts, technique, lit)?;
        Ok(Self { pass: DeferredPass::new(device, technique, lit)?, forward })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (depth, gbuffer) = (ports.texture("depth")?, ports.gbuffer("gbuffer")?);
        let mut light = self.pass.add_to(frame, &buffers, shadows, &depth, &gbuffer, view.background())?;
        self.forward.blended(frame, &buffers, shadows, &depth, view.geometry(), &mut light)?;
        ports.set("light", light);
        Ok(())
    }
}
