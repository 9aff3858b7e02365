//! `fxaa`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Fxaa as FxaaPass;

use crate::Error;
use crate::nodes::{Node, Port, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Fxaa {
    pass: FxaaPass,
}

impl Node for Fxaa {
    const NAME: &'static str = "fxaa";
    const ABOUT: &'static str = "smooths edges of a finished picture";
    const INPUTS: &'static [Port] =
        &[Port::texture("picture", "behind the tonemap").of(Format::Rgba8UnormSrgb)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("picture", "the same with smooth edges").of(Format::Rgba8UnormSrgb)];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: FxaaPass::new(build.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut target = ports.create("picture", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        self.pass.add_to(frame, &ports.texture("picture")?, &mut target);
        ports.set("picture", target);
        Ok(())
    }
}
