//! `view`

use shadowgraph_core::Frame;
use shadowgraph_lighting::post::Jitters;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::{Setting, SettingType, Settings};
use crate::render_view::RenderView;

pub(crate) struct ViewNode {
    jitters: Option<Jitters>,
}

impl ViewNode {
    /// The setting that jitters the camera.
    pub(crate) const JITTER: &'static str = "jitter";
}

impl Node for ViewNode {
    const NAME: &'static str = "view";
    const ABOUT: &'static str = "uploads the camera and the lights for all shaders";
    const INPUTS: &'static [Port] = &[];
    const OUTPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const SETTINGS: &'static [Setting] = &[Setting::new(
        Self::JITTER,
        SettingType::Toggle(false),
        "whether the camera is jittered in each frame, for `taa`",
    )];
    const GROUPS_ITSELF: bool = true;

    fn new(_context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        Ok(Self { jitters: settings.toggle(Self::JITTER)?.then(Jitters::default) })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let uniforms = view.uniforms();
        let uniforms = match &self.jitters {
            Some(jitters) => uniforms.jittered(jitters.next(view.index)),
            None => uniforms,
        };
        ports.set("view", uniforms.upload(frame));
        Ok(())
    }
}
