//! `bloom`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Bloom as BloomPasses;

use crate::Error;
use crate::nodes::{Node, Port, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Bloom {
    passes: BloomPasses,
    strength: f32,
    levels: u32,
}

impl Node for Bloom {
    const NAME: &'static str = "bloom";
    const ABOUT: &'static str = "spreads some of the light over its surroundings, as a lens does";
    const INPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same, with what spread").of(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new("strength", SettingType::Number(0.06, 0.0, 1.0), "the part that spreads"),
        Setting::new("levels", SettingType::Integer(6, 1, 10), "how far it spreads: each doubles it"),
    ];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        let passes = BloomPasses::new(build.device)?;
        Ok(Self {
            passes,
            strength: settings.number("strength")?,
            levels: settings.integer("levels")? as u32,
        })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let light = ports.texture("light")?;
        let mut target = ports.create("light", frame, view.texture_desc(Format::Rgba16Float));
        self.passes.add_to(frame, &light, &mut target, self.strength, self.levels);
        ports.set("light", target);
        Ok(())
    }
}
