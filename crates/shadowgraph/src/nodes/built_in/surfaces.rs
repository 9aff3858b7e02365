//! `surfaces`

use shadowgraph_core::Frame;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};
use crate::surfaces::SurfaceDrawer;

pub(super) struct Surfaces {
    drawer: Option<SurfaceDrawer>,
}

impl Node for Surfaces {
    const NAME: &'static str = "surfaces";
    const ABOUT: &'static str = "draws the surfaces that are seen where the technique asks for them, for pipelines without `geometry`";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera")];
    const OUTPUTS: &'static [Port] =
        &[Port::new("surfaces", PortKind::Surfaces, "positions and normals, for the technique").optional()];
    const GROUPS_ITSELF: bool = true;

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        let reads = build.technique.reads_surface_buffers();
        Ok(Self { drawer: reads.then(|| SurfaceDrawer::new(build.device, build.layouts)).transpose()? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        if let Some(drawer) = &self.drawer {
            let screen = drawer.screen_alone(frame, &ports.view("view")?, view.geometry())?;
            ports.set("surfaces", screen);
        }
        Ok(())
    }
}
