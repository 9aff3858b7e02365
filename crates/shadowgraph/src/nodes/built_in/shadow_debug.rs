//! `shadow_debug`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::{Forward, LitOutput, LitTarget};

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct ShadowDebug {
    passes: Forward,
}

impl Node for ShadowDebug {
    const NAME: &'static str = "shadow_debug";
    const ABOUT: &'static str = "draws the technique's debug colours, such as those of cascades";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera and the lights"),
        Port::new("shadows", PortKind::Shadows, "the shadows"),
        Port::texture("depth", "the depth of `geometry`").with_format(Format::Depth32Float),
    ];
    const OUTPUTS: &'static [Port] =
        &[Port::texture("colors", "sRGB colours, alpha 0 where nothing is drawn")
            .with_format(Format::Rgba8Unorm)];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        let BuildContext { device, layouts, technique, lit } = *context;
        let target = LitTarget { format: Format::Rgba8Unorm, output: LitOutput::Debug, ..lit };
        Ok(Self { passes: Forward::new(device, layouts, technique, target)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (buffers, shadows) = (ports.view("view")?, ports.shadows("shadows")?);
        let (depth, geometry) = (ports.texture("depth")?, view.geometry(frame));
        let colors = self.passes.lit(frame, &buffers, shadows, &depth, &geometry, [0.0; 4])?;
        ports.set("colors", colors);
        Ok(())
    }
}
