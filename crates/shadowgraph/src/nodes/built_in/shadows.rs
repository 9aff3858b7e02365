//! `shadows`

use shadowgraph_core::Frame;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

/// Adds the shadows of the technique that the pipeline is built with.
pub(crate) struct Shadows;

impl Shadows {
    /// The setting that names the technique.
    pub(crate) const TECHNIQUE: &'static str = "technique";
    /// The setting that computes shadows in a screen-space mask.
    pub(crate) const SCREEN_SPACE: &'static str = "screen_space";
}

impl Node for Shadows {
    const NAME: &'static str = "shadows";
    const ABOUT: &'static str = "adds the shadow passes of a technique for all lights";
    const INPUTS: &'static [Port] =
        &[Port::new("surfaces", PortKind::Surfaces, "positions and normals, for techniques that read them")
            .optional()];
    const OUTPUTS: &'static [Port] =
        &[Port::new("shadows", PortKind::Shadows, "the shadows, for lighting nodes")];
    const SETTINGS: &'static [Setting] = &[
        Setting::new(
            Self::TECHNIQUE,
            SettingType::Text(""),
            "the name of a technique; if empty, that of the render configuration",
        ),
        Setting::new(
            Self::SCREEN_SPACE,
            SettingType::Toggle(false),
            "whether shadows are computed in a screen-space mask before lighting",
        ),
    ];
    const GROUPS_ITSELF: bool = true;

    fn new(_context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self)
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let surfaces = ports.surfaces("surfaces")?;
        let shadows = view.add_shadows(frame, surfaces.as_ref())?;
        ports.set("shadows", shadows);
        Ok(())
    }
}
