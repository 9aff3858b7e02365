//! `tonemap`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::Tonemap as TonemapPass;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct Tonemap {
    pass: TonemapPass,
}

impl Node for Tonemap {
    const NAME: &'static str = "tonemap";
    const ABOUT: &'static str = "tonemaps light with a filmic curve";
    const INPUTS: &'static [Port] = &[
        Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float),
        Port::texture("exposure", "one texel, a further factor of all light")
            .with_format(Format::R32Float)
            .optional(),
    ];
    const OUTPUTS: &'static [Port] = &[Port::texture("image", "the tonemapped image, 8 bits per channel")
        .with_format(Format::Rgba8UnormSrgb)];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: TonemapPass::new(context.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut image = ports.create("image", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        let exposure = ports.is_connected("exposure").then(|| ports.texture("exposure")).transpose()?;
        self.pass.add_to(frame, &ports.texture("light")?, &mut image, &view.tonemap_settings(exposure));
        ports.set("image", image);
        Ok(())
    }
}
