//! `fog`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::LitOutput;
use shadowgraph_lighting::post::{Fog as FogPass, FogSettings};

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Fog {
    pass: FogPass,
    settings: FogSettings,
}

impl Node for Fog {
    const NAME: &'static str = "fog";
    const ABOUT: &'static str = "lays thin fog over light, in which lights and shadows are seen as shafts";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "of what is drawn, of one sample").of(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float).taken(),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same, with fog before it").of(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "albedo",
            SettingType::Color([1.0; 3]),
            "the part of light that is scattered, not swallowed",
        ),
        Setting::new("density", SettingType::Number(0.01, 0.0, 10.0), "how much is lost").in_units("per m"),
        Setting::new("height_m", SettingType::Number(4.0, -1e5, 1e5), "up to where it is dense")
            .in_units("m"),
        Setting::new("falloff", SettingType::Number(0.1, 0.0, 100.0), "how fast it gets thinner above")
            .in_units("per m"),
        Setting::new(
            "anisotropy",
            SettingType::Number(0.4, -0.95, 0.95),
            "-1: back to the light, 1: onwards",
        ),
        Setting::new("distance_m", SettingType::Number(80.0, 0.01, 1e6), "how far it is looked for")
            .in_units("m"),
        Setting::new("steps", SettingType::Integer(24, 1, 256), "in how many steps"),
    ];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        build.one_sample(Self::NAME)?;
        let own = FogSettings {
            albedo: settings.color("albedo")?,
            density: settings.number("density")?,
            height_m: settings.number("height_m")?.into(),
            falloff: settings.number("falloff")?,
            anisotropy: settings.number("anisotropy")?,
            distance_m: settings.number("distance_m")?,
            steps: settings.integer("steps")? as u32,
        };
        Ok(Self { pass: FogPass::new(build.device, build.technique)?, settings: own })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut light = ports.texture("light")?;
        if view.output == LitOutput::Light {
            let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
            let (depth, origin_y) = (ports.texture("depth")?, view.casters.scene.origin_world().y);
            let textures = [&depth, &light];
            light = self.pass.add_to(frame, &buffers, shadows, textures, origin_y, &self.settings)?;
        }
        ports.set("light", light);
        Ok(())
    }
}
