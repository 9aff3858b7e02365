//! `view`

use shadowgraph_core::Frame;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct ViewRecords;

impl Node for ViewRecords {
    const NAME: &'static str = "view";
    const ABOUT: &'static str = "writes the camera and the lights for every shader";
    const INPUTS: &'static [Port] = &[];
    const OUTPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const GROUPS_ITSELF: bool = true;

    fn new(_build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self)
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        ports.set("view", view.records().upload(frame));
        Ok(())
    }
}
