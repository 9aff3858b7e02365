//! `clusters`

use shadowgraph_core::Frame;
use shadowgraph_lighting::Clusters as ClusterPass;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;

pub(super) struct Clusters {
    pass: ClusterPass,
}

impl Node for Clusters {
    const NAME: &'static str = "clusters";
    const ABOUT: &'static str =
        "assigns lights to clusters of the view frustum; pixels evaluate only the lights of their cluster";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera and the lights")];
    const OUTPUTS: &'static [Port] =
        &[Port::new("view", PortKind::View, "the same with the clusters, for lighting nodes")];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        Ok(Self { pass: ClusterPass::new(context.device)? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let found = self.pass.add_to(frame, &ports.view("view")?, view.lights.len());
        ports.set("view", found);
        Ok(())
    }
}
