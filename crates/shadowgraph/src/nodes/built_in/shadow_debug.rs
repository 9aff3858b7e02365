//! `shadow_debug`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::{Forward, LitOutput, LitTarget};

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct ShadowDebug {
    passes: Forward,
}

impl Node for ShadowDebug {
    const NAME: &'static str = "shadow_debug";
    const ABOUT: &'static str = "draws the technique's debug colours, such as those of cascades";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "that of `geometry`").of(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("colors", "as they are to be seen, alpha 0 where nothing is").of(Format::Rgba8Unorm)];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        let Build { device, layouts, technique, lit } = *build;
        let target = LitTarget { format: Format::Rgba8Unorm, output: LitOutput::Debug, ..lit };
        Ok(Self { passes: Forward::new(device, layouts, technique, target)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (depth, geometry) = (ports.texture("depth")?, view.geometry());
        let colors = self.passes.lit(frame, &buffers, shadows, &depth, geometry, [0.0; 4])?;
        ports.set("colors", colors);
        Ok(())
    }
}
