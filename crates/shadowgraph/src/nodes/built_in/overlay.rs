//! `overlay`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Overlay as OverlayPass;

use crate::Error;
use crate::nodes::{Node, Port, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Overlay {
    pass: OverlayPass,
    strength: f32,
}

impl Node for Overlay {
    const NAME: &'static str = "overlay";
    const ABOUT: &'static str = "lays colours over a finished picture";
    const INPUTS: &'static [Port] = &[
        Port::texture("picture", "behind the tonemap").of(Format::Rgba8UnormSrgb),
        Port::texture("colors", "as they are to be seen").or_texel([0.0; 4]),
    ];
    const OUTPUTS: &'static [Port] = &[Port::texture("picture", "both").of(Format::Rgba8UnormSrgb)];
    const SETTINGS: &'static [Setting] =
        &[Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "1: nothing but the colours")];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: OverlayPass::new(build.device)?, strength: settings.number("strength")? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (picture, colors) = (ports.texture("picture")?, ports.texture_or_stand_in("colors", frame)?);
        let mut target = ports.create("picture", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        self.pass.add_to(frame, [&picture, &colors], &mut target, self.strength);
        ports.set("picture", target);
        Ok(())
    }
}
