//! `surfaces`

use shadowgraph_core::Frame;
use shadowgraph_shadows::SurfaceBuffers;

use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;
use crate::surfaces::SurfaceDrawer;

pub(super) struct Surfaces {
    drawer: Option<SurfaceDrawer>,
}

impl Node for Surfaces {
    const NAME: &'static str = "surfaces";
    const ABOUT: &'static str =
        "draws positions and normals if the technique reads them, for pipelines without `geometry`";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera")];
    const OUTPUTS: &'static [Port] =
        &[Port::new("surfaces", PortKind::Surfaces, "positions and normals, for the technique").optional()];
    const GROUPS_ITSELF: bool = true;

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        let reads = context.technique.reads_surface_buffers();
        Ok(Self { drawer: reads.then(|| SurfaceDrawer::new(context.device, context.layouts)).transpose()? })
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        if let Some(drawer) = &self.drawer {
            let geometry = view.geometry(frame);
            let surfaces = drawer.surface_buffers_with_prepass(frame, &ports.view("view")?, &geometry)?;
            ports.set("surfaces", SurfaceBuffers { ground_height: view.ground_height(), ..surfaces });
        }
        Ok(())
    }
}
