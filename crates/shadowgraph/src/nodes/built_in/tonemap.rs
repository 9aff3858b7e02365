//! `tonemap`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::Tonemap as TonemapPass;

use crate::Error;
use crate::nodes::{Node, Port, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Tonemap {
    pass: TonemapPass,
}

impl Node for Tonemap {
    const NAME: &'static str = "tonemap";
    const ABOUT: &'static str = "makes a picture of light, by a filmic curve";
    const INPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("picture", "eight bits a channel").of(Format::Rgba8UnormSrgb)];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: TonemapPass::new(build.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut picture = ports.create("picture", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        self.pass.add_to(frame, &ports.texture("light")?, &mut picture);
        ports.set("picture", picture);
        Ok(())
    }
}
