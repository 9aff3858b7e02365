//! `overlay`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Overlay as OverlayPass;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct Overlay {
    pass: OverlayPass,
    strength: f32,
}

impl Node for Overlay {
    const NAME: &'static str = "overlay";
    const ABOUT: &'static str = "blends colours over a tonemapped image";
    const INPUTS: &'static [Port] = &[
        Port::texture("image", "the tonemapped image").with_format(Format::Rgba8UnormSrgb),
        Port::texture("colors", "sRGB colours with alpha").or_placeholder([0.0; 4]),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("image", "the image with the colours").with_format(Format::Rgba8UnormSrgb)];
    const SETTINGS: &'static [Setting] =
        &[Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "opacity of the colours")];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: OverlayPass::new(context.device)?, strength: settings.number("strength")? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (image, colors) = (ports.texture("image")?, ports.texture_or_placeholder("colors", frame)?);
        let mut target = ports.create("image", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        self.pass.add_to(frame, [&image, &colors], &mut target, self.strength);
        ports.set("image", target);
        Ok(())
    }
}
