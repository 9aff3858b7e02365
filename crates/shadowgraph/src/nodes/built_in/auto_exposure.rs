//! `auto_exposure`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::{AutoExposure as AutoExposurePasses, AutoExposureSettings};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct AutoExposure {
    passes: AutoExposurePasses,
    settings: AutoExposureSettings,
}

impl Node for AutoExposure {
    const NAME: &'static str = "auto_exposure";
    const ABOUT: &'static str = "computes an exposure from the histogram of the image";
    const INPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("exposure", "one texel, a factor for `tonemap`").with_format(Format::R32Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            "key",
            SettingType::Number(0.35, 0.01, 10.0),
            "the brightness to which the median is brought; white in full light is 1",
        ),
        Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "how much of the way there"),
        Setting::new(
            "highlights",
            SettingType::Number(0.01, 0.0, 0.5),
            "the share of the pixels that may be brighter than `white`",
        ),
        Setting::new("white", SettingType::Number(2.5, 0.1, 100.0), "the brightness that others stay below"),
        Setting::new(
            "range_stops",
            SettingType::Number(3.0, 0.0, 16.0),
            "how much darker and brighter it may get",
        )
        .in_units("stops"),
        Setting::new(
            "adaptation",
            SettingType::Number(1.0, 0.001, 1.0),
            "the weight of a frame after others; 1: each frame has the exposure of its image",
        ),
    ];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        let settings = AutoExposureSettings {
            key: settings.number("key")?,
            strength: settings.number("strength")?,
            highlights: settings.number("highlights")?,
            white: settings.number("white")?,
            range_stops: settings.number("range_stops")?,
            adaptation: settings.number("adaptation")?,
        };
        Ok(Self { passes: AutoExposurePasses::new(context.device)?, settings })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let exposure = self.passes.add_to(frame, &ports.texture("light")?, &self.settings);
        ports.set("exposure", exposure);
        Ok(())
    }
}
