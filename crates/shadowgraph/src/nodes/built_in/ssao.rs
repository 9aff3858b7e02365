//! `ssao`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::{Occlusion, OcclusionSettings};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct Ssao {
    passes: Occlusion,
    settings: OcclusionSettings,
}

impl Node for Ssao {
    const NAME: &'static str = "ssao";
    const ABOUT: &'static str = "computes screen-space ambient occlusion from depth";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "the depth of `geometry`").with_format(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the same with the occlusion, for lighting nodes"),
        Port::texture("occlusion", "ambient visibility: 1 where nothing occludes")
            .with_format(Format::R8Unorm),
    ];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "radius_m",
            SettingType::Number(0.8, 0.0, 100.0),
            "radius within which geometry occludes; 0: a tenth of the image's height at each pixel's depth",
        )
        .in_units("metres"),
        Setting::new("power", SettingType::Number(1.0, 0.1, 8.0), "exponent; values above 1 darken corners"),
        Setting::new("slices", SettingType::Integer(3, 1, 8), "directions in which the horizon is searched"),
        Setting::new("steps", SettingType::Integer(4, 1, 16), "steps per direction"),
    ];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        let settings = OcclusionSettings {
            radius_m: settings.number("radius_m")?,
            power: settings.number("power")?,
            slices: settings.integer("slices")? as u32,
            steps: settings.integer("steps")? as u32,
        };
        Ok(Self { passes: Occlusion::new(context.device)?, settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f RenderView<'f>,
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
