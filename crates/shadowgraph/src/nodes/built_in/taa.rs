//! `taa`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::Velocity;
use shadowgraph_lighting::post::Temporal;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(crate) struct Taa {
    pass: Temporal,
    current_weight: f32,
}

impl Node for Taa {
    const NAME: &'static str = "taa";
    const ABOUT: &'static str =
        "temporal anti-aliasing: blends the frame with earlier frames; needs `view` with jitter";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "depth with one sample per pixel").with_format(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").with_format(Format::Rgba16Float),
        Port::texture("velocity", "motion vectors; without them moving objects leave trails")
            .with_format(Velocity::FORMAT)
            .optional(),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("light", "accumulated over frames").with_format(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] = &[Setting::new(
        "current_weight",
        SettingType::Number(0.1, 0.01, 1.0),
        "the weight of the current frame",
    )];
    const TEMPORAL: bool = true;

    fn new(context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        context.require_single_sample(Self::NAME)?;
        Ok(Self { pass: Temporal::new(context.device)?, current_weight: settings.number("current_weight")? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        _view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (light, depth) = (ports.texture("light")?, ports.texture("depth")?);
        let velocity = ports.is_connected("velocity").then(|| ports.texture("velocity")).transpose()?;
        let (buffers, weight) = (ports.view("view")?, self.current_weight);
        let accumulated = self.pass.add_to(frame, [&light, &depth], velocity.as_ref(), &buffers, weight);
        ports.set("light", accumulated);
        Ok(())
    }
}
