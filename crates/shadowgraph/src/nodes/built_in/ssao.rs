//! `ssao`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::{Occlusion, OcclusionSettings};

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Ssao {
    passes: Occlusion,
    settings: OcclusionSettings,
}

impl Node for Ssao {
    const NAME: &'static str = "ssao";
    const ABOUT: &'static str =
        "finds how much of the light from all around reaches what is seen, in the depth of the picture";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "that of `geometry`, of one sample").of(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the same, with what was found out: for whoever lights"),
        Port::texture("occlusion", "1 where all of it arrives").of(Format::R8Unorm),
    ];
    const SETTINGS: &'static [Setting] = &[
        Setting::new("radius_m", SettingType::Number(0.8, 0.01, 100.0), "how far surroundings matter")
            .in_units("m"),
        Setting::new("power", SettingType::Number(1.0, 0.1, 8.0), "over 1 corners are darker"),
        Setting::new(
            "slices",
            SettingType::Integer(3, 1, 8),
            "in how many directions horizons are looked for",
        ),
        Setting::new("steps", SettingType::Integer(4, 1, 16), "in how many steps each way"),
    ];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        build.one_sample(Self::NAME)?;
        let settings = OcclusionSettings {
            radius_m: settings.number("radius_m")?,
            power: settings.number("power")?,
            slices: settings.integer("slices")? as u32,
            steps: settings.integer("steps")? as u32,
        };
        Ok(Self { passes: Occlusion::new(build.device)?, settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let found = self.passes.add_to(frame, &ports.view("view")?, &ports.texture("depth")?, &self.settings);
        if let Some(occlusion) = &found.occlusion {
            ports.set("occlusion", occlusion.clone());
        }
        ports.set("view", found);
        Ok(())
    }
}
