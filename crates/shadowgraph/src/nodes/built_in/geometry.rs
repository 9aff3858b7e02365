//! `geometry`

use shadowgraph_core::{Format, Frame, Texture};
use shadowgraph_lighting::{Prepass, ViewBuffers};
use shadowgraph_shadows::SurfaceBuffers;

use crate::Error;
use crate::nodes::{Node, Port, PortKind, Ports, Settings};
use crate::pipelines::{Build, View};
use crate::surfaces::SurfaceDrawer;

/// What is seen: its depth, and where the technique asks for it, its surfaces.
pub struct Geometry {
    prepass: Prepass,
    surfaces: Option<SurfaceDrawer>,
    samples: u32,
}

impl Geometry {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        let reads = build.technique.reads_surface_buffers();
        let surfaces = reads.then(|| SurfaceDrawer::new(build.device, build.layouts)).transpose()?;
        let samples = build.lit.samples;
        Ok(Self { prepass: Prepass::new(build.device, build.layouts, samples)?, surfaces, samples })
    }

    /// Adds the passes and returns the depth, and the surfaces where the technique asks for them.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        buffers: &ViewBuffers,
    ) -> Result<(Texture, Option<SurfaceBuffers>), Error> {
        let geometry = view.geometry();
        let depth = self.prepass.add_to(frame, buffers, geometry);
        let screen = self.surfaces.as_ref().map(|drawer| match self.samples {
            1 => drawer.screen(frame, buffers, &depth, geometry),
            _ => drawer.screen_alone(frame, buffers, geometry),
        });
        Ok((depth, screen.transpose()?))
    }
}

impl Node for Geometry {
    const NAME: &'static str = "geometry";
    const ABOUT: &'static str =
        "draws the depth of what is seen, and its surfaces where the technique asks for them";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera")];
    const OUTPUTS: &'static [Port] = &[
        Port::texture("depth", "reversed depth, with as many samples as colours have")
            .of(Format::Depth32Float),
        Port::new("surfaces", PortKind::Surfaces, "positions and normals, for the technique").optional(),
    ];

    fn new(build: &Build<'_>, _settings: &Settings) -> Result<Self, Error> {
        Self::new(build)
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let (depth, surfaces) = self.add_to(frame, view, &ports.view("view")?)?;
        ports.set("depth", depth);
        if let Some(surfaces) = surfaces {
            ports.set("surfaces", surfaces);
        }
        Ok(())
    }
}
