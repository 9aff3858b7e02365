//! `taa`

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Temporal;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Setting, SettingType, Settings};
use crate::pipelines::{Build, View};

pub(crate) struct Taa {
    pass: Temporal,
    fresh: f32,
}

impl Node for Taa {
    const NAME: &'static str = "taa";
    const ABOUT: &'static str =
        "mixes this frame's light with that of the frames before: wants `view` with jitter";
    const INPUTS: &'static [Port] = &[
        Port::new("view", PortKind::View, "the camera"),
        Port::texture("depth", "of what is drawn, of one sample").of(Format::Depth32Float),
        Port::texture("light", "scene-linear, exposure applied").of(Format::Rgba16Float),
    ];
    const OUTPUTS: &'static [Port] = &[Port::texture("light", "of several frames").of(Format::Rgba16Float)];
    const SETTINGS: &'static [Setting] =
        &[Setting::new("fresh", SettingType::Number(0.1, 0.01, 1.0), "the part of this frame")];

    fn new(build: &Build<'_>, settings: &Settings) -> Result<Self, Error> {
        build.one_sample(Self::NAME)?;
        Ok(Self { pass: Temporal::new(build.device)?, fresh: settings.number("fresh")? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (light, depth) = (ports.texture("light")?, ports.texture("depth")?);
        let of_view = (view.number, &view.options.camera);
        let buffers = ports.view("view")?;
        let mixed = self.pass.add_to(frame, [&light, &depth], of_view, &buffers, self.fresh);
        ports.set("light", mixed);
        Ok(())
    }
}
