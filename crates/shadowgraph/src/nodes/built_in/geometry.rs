//! `geometry`

use shadowgraph_core::{Format, Frame, Texture};
use shadowgraph_lighting::{OcclusionCulling, Prepass, ViewBuffers};
use shadowgraph_shadows::SurfaceBuffers;

use super::velocity::VelocityOutput;
use crate::build_context::BuildContext;
use crate::error::Error;
use crate::nodes::node::Node;
use crate::nodes::port::{Port, PortKind};
use crate::nodes::ports::Ports;
use crate::nodes::setting::Settings;
use crate::render_view::RenderView;
use crate::surfaces::SurfaceDrawer;

/// A depth prepass, and positions and normals if the technique reads them.
pub struct Geometry {
    prepass: Prepass,
    surfaces: Option<SurfaceDrawer>,
    velocity: VelocityOutput,
    samples: u32,
    /// Culls what is hidden, if the GPU culls.
    occlusion: Option<OcclusionCulling>,
}

impl Geometry {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// None with the built-in WGSL.
    pub fn new(context: &BuildContext<'_>) -> Result<Self, Error> {
        let reads = context.technique.reads_surface_buffers();
        let surfaces = reads.then(|| SurfaceDrawer::new(context.device, context.layouts)).transpose()?;
        let samples = context.lit.samples;
        let prepass = Prepass::new(context.device, context.layouts, samples)?;
        // A depth pyramid has one sample per pixel.
        let occlusion = (samples == 1).then(|| OcclusionCulling::new(context.device)).transpose()?;
        Ok(Self { prepass, surfaces, velocity: VelocityOutput::new(context), samples, occlusion })
    }

    /// Adds the passes and returns the depth, and the surfaces if the technique reads them.
    ///
    /// # Errors
    /// None with the built-in WGSL.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        buffers: &ViewBuffers,
    ) -> Result<(Texture, Option<SurfaceBuffers>), Error> {
        let depth = match self.occlusion.as_ref().filter(|_| view.casters.culls_on_gpu()) {
            Some(occlusion) => view.add_occluded_prepass(frame, (occlusion, &self.prepass), buffers),
            None => {
                let geometry = view.geometry(frame);
                self.prepass.add_to(frame, buffers, &geometry)
            }
        };
        frame.note(&depth, view.casters.culling());
        let geometry = &view.geometry(frame);
        let surfaces = self.surfaces.as_ref().map(|drawer| match self.samples {
            1 => drawer.surface_buffers(frame, buffers, &depth, geometry),
            _ => drawer.surface_buffers_with_prepass(frame, buffers, geometry),
        });
        let above_ground = |surfaces| SurfaceBuffers { ground_height: view.ground_height(), ..surfaces };
        Ok((depth, surfaces.transpose()?.map(above_ground)))
    }
}

impl Node for Geometry {
    const NAME: &'static str = "geometry";
    const ABOUT: &'static str =
        "draws a depth prepass, and positions and normals if the technique reads them";
    const INPUTS: &'static [Port] = &[Port::new("view", PortKind::View, "the camera")];
    const OUTPUTS: &'static [Port] = &[
        Port::texture("depth", "reversed depth, with the sample count of the colours")
            .with_format(Format::Depth32Float),
        Port::new("surfaces", PortKind::Surfaces, "positions and normals, for the technique").optional(),
        VelocityOutput::PORT,
    ];

    fn new(context: &BuildContext<'_>, _settings: &Settings) -> Result<Self, Error> {
        Self::new(context)
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let buffers = ports.view("view")?;
        let (depth, surfaces) = self.add_to(frame, view, &buffers)?;
        self.velocity.set(frame, view, (&buffers, &depth), ports)?;
        ports.set("depth", depth);
        if let Some(surfaces) = surfaces {
            ports.set("surfaces", surfaces);
        }
        Ok(())
    }
}
