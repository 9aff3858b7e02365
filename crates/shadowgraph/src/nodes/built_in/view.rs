//! `view`

use shadowgraph_core::Frame;
use shadowgraph_lighting::post::Jitters;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(crate) struct ViewUniforms {
    jitters: Option<Jitters>,
}

impl ViewUniforms {
    /// The setting that makes the camera jitter.
    pub(crate) const JITTER: &'static str = "jitter";
}

impl Node for ViewUniforms {
    const NAME: &'static str = "view";
    const ABOUT: &'static str = "writes the camera and the lights for every shader";
    const INPUTS: &'static [Port] = &[];
    const OUTPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const SETTINGS: &'static [Setting] = &[Setting::new(
        Self::JITTER,
        SettingType::Toggle(false),
        "whether pixels look at another place in each frame, for `taa`",
    )];
    const GROUPS_ITSELF: bool = true;

    fn new(_build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        Ok(Self { jitters: settings.toggle(Self::JITTER)?.then(Jitters::default) })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let uniforms = view.uniforms();
        let uniforms = match &self.jitters {
            Some(jitters) => uniforms.jittered(jitters.next(view.number)),
            None => uniforms,
        };
        ports.set("view", uniforms.upload(frame));
        Ok(())
    }
}
