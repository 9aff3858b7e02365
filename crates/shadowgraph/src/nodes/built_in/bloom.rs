//! `bloom`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Bloom as BloomPasses;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::Port;
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(super) struct Bloom {
    passes: BloomPasses,
    strength: f32,
    levels: u32,
}

impl Node for Bloom {
    const NAME: &'static str = "bloom";
    const ABOUT: &'static str = "adds bloom: bright light spreads over its surroundings, as in a lens";
    const INPUTS: &'static [Port] =
        &[Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float)];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "the same, with bloom").with_format(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[
        Setting::new("strength", SettingType::Number(0.06, 0.0, 1.0), "the fraction of light that spreads"),
        Setting::new("levels", SettingType::Integer(6, 1, 10), "mip levels; each doubles the radius"),
    ];

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        let passes = BloomPasses::new(context.device)?;
        Ok(Self {
            passes,
            strength: settings.number("strength")?,
            levels: settings.integer("levels")? as u32,
        })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let light = ports.texture("light")?;
        let mut target = ports.create("light", frame, view.texture_desc(Format::Rgba16Float));
        self.passes.add_to(frame, &light, &mut target, self.strength, self.levels);
        ports.set("light", target);
        Ok(())
    }
}
