//! `fog`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::LitOutput;
use shadowgraph_lighting::post::{Fog as FogPass, FogSettings};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct Fog {
    pass: FogPass,
    settings: FogSettings,
}

impl Node for Fog {
    const NAME: &'static str = "fog";
    const ABOUT: &'static str = "adds volumetric fog with light shafts";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "depth with one sample per pixel").with_format(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float).in_place(),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same with fog").with_format(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "albedo",
            SettingType::Color([1.0; 3]),
            "the fraction of light that is scattered and not absorbed",
        ),
        Setting::new("density", SettingType::Number(0.01, 0.0, 10.0), "extinction coefficient")
            .in_units("per metre"),
        Setting::new(
            "height_m",
            SettingType::Number(4.0, -1e5, 1e5),
            "the height up to which density is constant",
        )
        .in_units("metres"),
        Setting::new(
            "falloff",
            SettingType::Number(0.1, 0.0, 100.0),
            "exponential falloff of density above `height_m`",
        )
        .in_units("per metre"),
        Setting::new(
            "anisotropy",
            SettingType::Number(0.4, -0.95, 0.95),
            "asymmetry of the phase function: negative scatters backwards, positive forwards",
        ),
        Setting::new(
            "distance_m",
            SettingType::Number(80.0, 0.01, 1e6),
            "the distance that rays are marched",
        )
        .in_units("metres"),
        Setting::new("steps", SettingType::Integer(24, 1, 256), "ray-marching steps"),
    ];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        context.require_single_sample(Self::NAME)?;
        let fog_settings = FogSettings {
            albedo: settings.color("albedo")?,
            density: settings.number("density")?,
            height_m: settings.number("height_m")?.into(),
            falloff: settings.number("falloff")?,
            anisotropy: settings.number("anisotropy")?,
            distance_m: settings.number("distance_m")?,
            steps: settings.integer("steps")? as u32,
        };
        Ok(Self { pass: FogPass::new(context.device, context.technique)?, settings: fog_settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut light = ports.texture("light")?;
        if view.lit_output == LitOutput::Light {
            let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
            let (depth, origin_y) = (ports.texture("depth")?, view.casters.scene.origin_world().y);
            let textures = [&depth, &light];
            light = self.pass.add_to(frame, &buffers, shadows, textures, origin_y, &self.settings)?;
        }
        ports.set("light", light);
        Ok(())
    }
}
