//! `fxaa`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Fxaa as FxaaPass;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct Fxaa {
    pass: FxaaPass,
}

impl Node for Fxaa {
    const NAME: &'static str = "fxaa";
    const ABOUT: &'static str = "smooths edges of a tonemapped image";
    const INPUTS: &'static [Port] =
        &[Port::texture("image", "the tonemapped image").with_format(Format::Rgba8UnormSrgb)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("image", "the same with smooth edges").with_format(Format::Rgba8UnormSrgb)];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: FxaaPass::new(context.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut target = ports.create("image", frame, view.texture_desc(Format::Rgba8UnormSrgb));
        self.pass.add_to(frame, &ports.texture("image")?, &mut target);
        ports.set("image", target);
        Ok(())
    }
}
