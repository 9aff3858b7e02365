//! `clusters`

use shadowgraph_core::Frame;
use shadowgraph_lighting::Clusters as ClusterPass;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};

pub(super) struct Clusters {
    pass: ClusterPass,
}

impl Node for Clusters {
    const NAME: &'static str = "clusters";
    const ABOUT: &'static str =
        "finds which lights reach which part of the view, so that each pixel asks few of many";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const OUTPUTS: &'static [Port] =
        &[Port::new("view", PortKind::View, "the same, with what was found out: for whoever lights")];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: ClusterPass::new(build.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let found = self.pass.add_to(frame, &ports.view("view")?, view.lights.len());
        ports.set("view", found);
        Ok(())
    }
}
