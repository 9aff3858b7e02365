//! `sky`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::LitOutput;
use shadowgraph_lighting::post::{Sky as SkyPass, SkySettings};

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Sky {
    pass: SkyPass,
    settings: SkySettings,
}

impl Node for Sky {
    const NAME: &'static str = "sky";
    const ABOUT: &'static str =
        "draws a plain sky, with the discs of directional lights, where nothing else is";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::texture("depth", "of what is drawn, of one sample").of(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float).taken(),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same, with the sky behind it").of(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "disc_rad",
            SettingType::Number(0.012, 0.0, 0.5),
            "radius of the discs; the sun's is 0.00465",
        )
        .in_units("rad"),
        Setting::new("haze", SettingType::Number(0.8, 0.0, 10.0), "how much brighter the horizon is"),
    ];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        build.one_sample(Self::NAME)?;
        let settings = SkySettings { disc_rad: settings.number("disc_rad")?, haze: settings.number("haze")? };
        Ok(Self { pass: SkyPass::new(build.device)?, settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut light = ports.texture("light")?;
        if view.output == LitOutput::Light {
            let (buffers, depth) = (ports.view("view")?, ports.texture("depth")?);
            self.pass.add_to(frame, &buffers, &depth, &mut light, &self.settings);
        }
        ports.set("light", light);
        Ok(())
    }
}
