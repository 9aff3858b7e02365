//! `hi_z`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::DepthPyramid;

use crate::Error;
use crate::nodes::{Node, Port, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct HiZ {
    passes: DepthPyramid,
}

impl Node for HiZ {
    const NAME: &'static str = "hi_z";
    const ABOUT: &'static str = "halves depth again and again, each texel the farthest of those below it";
    const INPUTS: &'static [Port] =
        &[Port::texture("depth", "reversed, of one sample").of(Format::Depth32Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("pyramid", "with all mips down to one texel").of(Format::R32Float)];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        build.one_sample(Self::NAME)?;
        Ok(Self { passes: DepthPyramid::new(build.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let pyramid = self.passes.add_to(frame, &ports.texture("depth")?);
        ports.set("pyramid", pyramid);
        Ok(())
    }
}
