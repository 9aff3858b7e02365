//! `sky`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::LitOutput;
use shadowgraph_lighting::post::{Sky as SkyPass, SkySettings};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct Sky {
    pass: SkyPass,
    settings: SkySettings,
}

impl Node for Sky {
    const NAME: &'static str = "sky";
    const ABOUT: &'static str = "draws a sky with the discs of directional lights behind the geometry";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::texture("depth", "depth with one sample per pixel").with_format(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float).in_place(),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same with a sky").with_format(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "disc_rad",
            SettingType::Number(0.012, 0.0, 0.5),
            "angular radius of the discs; the sun's is 0.00465",
        )
        .in_units("radians"),
        Setting::new("haze", SettingType::Number(0.8, 0.0, 10.0), "extra brightness of the horizon"),
    ];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        context.require_single_sample(Self::NAME)?;
        let settings = SkySettings { disc_rad: settings.number("disc_rad")?, haze: settings.number("haze")? };
        Ok(Self { pass: SkyPass::new(context.device)?, settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut light = ports.texture("light")?;
        if view.lit_output == LitOutput::Light {
            let (buffers, depth) = (ports.view("view")?, ports.texture("depth")?);
            self.pass.add_to(frame, &buffers, &depth, &mut light, &self.settings);
        }
        ports.set("light", light);
        Ok(())
    }
}
