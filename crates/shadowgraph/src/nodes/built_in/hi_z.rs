//! `hi_z`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::DepthPyramid;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct HiZ {
    passes: DepthPyramid,
}

impl Node for HiZ {
    const NAME: &'static str = "hi_z";
    const ABOUT: &'static str =
        "builds a depth pyramid; each texel holds the farthest depth of the four below it";
    const INPUTS: &'static [Port] =
        &[Port::texture("depth", "reversed depth with one sample per pixel")
            .with_format(Format::Depth32Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("pyramid", "all mips down to one texel").with_format(Format::R32Float)];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        context.require_single_sample(Self::NAME)?;
        Ok(Self { passes: DepthPyramid::new(context.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let pyramid = self.passes.add_to(frame, &ports.texture("depth")?);
        ports.set("pyramid", pyramid);
        Ok(())
    }
}
