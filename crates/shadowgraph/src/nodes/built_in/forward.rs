//! `forward`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::Forward as ForwardPasses;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Forward {
    passes: ForwardPasses,
}

impl Node for Forward {
    const NAME: &'static str = "forward";
    const ABOUT: &'static str = "draws what is seen, lit by every light, each pixel asking for its shadows";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "that of `geometry`; without it what is covered later is lit too")
            .of(Format::Depth32Float)
            .optional(),
    ];
    const OUTPUTS: &'static [Port] = &[
        Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float),
        Port::texture("depth", "reversed depth").of(Format::Depth32Float),
    ];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        let passes = ForwardPasses::new(build.device, build.layouts, build.technique, build.lit)?;
        Ok(Self { passes })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (geometry, background) = (view.geometry(), view.background());
        let (light, depth) = if ports.has("depth") {
            let depth = ports.texture("depth")?;
            (self.passes.lit(frame, &buffers, shadows, &depth, geometry, background)?, depth)
        } else {
            self.passes.lit_without_prepass(frame, &buffers, shadows, geometry, background)?
        };
        ports.set("light", light);
        ports.set("depth", depth);
        Ok(())
    }
}
