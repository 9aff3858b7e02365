//! The pass that draws the visible surfaces of a view.

use shadowgraph_core::{Format, Frame, Texture};
use shadowgraph_lighting::{Forward, Geometry, LitOutput, LitTarget, Prepass, ViewBuffers};
use shadowgraph_scene::gpu::MaterialLayouts;
use shadowgraph_shadows::{NoShadows, ShadowOutputs, SurfaceBuffers};

use crate::error::Error;

/// The pass that draws positions and geometric normals.
pub struct SurfaceDrawer {
    prepass: Prepass,
    forward: Forward,
}

impl SurfaceDrawer {
    /// Creates the pipelines.
    ///
    /// # Errors
    /// None with the WGSL of this version.
    pub fn new(device: &wgpu::Device, layouts: &MaterialLayouts) -> Result<Self, Error> {
        let target = LitTarget { format: Format::Rgba32Float, output: LitOutput::Surface, samples: 1 };
        let forward = Forward::new(device, layouts, &NoShadows, target)?;
        Ok(Self { prepass: Prepass::new(device, layouts, 1)?, forward })
    }

    /// Adds the pass after a prepass that drew `depth`.
    ///
    /// # Errors
    /// [`Error::Lighting`] if a pipeline variant cannot be created.
    pub fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        depth: &Texture,
        geometry: &Geometry<'f>,
    ) -> Result<Texture, Error> {
        let none = ShadowOutputs::default();
        Ok(self.forward.lit(frame, view, &none, depth, geometry, [0.0; 4])?)
    }

    /// Adds a separate prepass and the pass for a technique that reads surfaces, if the view's prepass has several samples or there
    /// is none.
    ///
    /// # Errors
    /// [`Error::Lighting`] if a pipeline variant cannot be created.
    pub fn surface_buffers_with_prepass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        geometry: &Geometry<'f>,
    ) -> Result<SurfaceBuffers, Error> {
        frame.node("one sample", |frame| {
            let depth = self.prepass.add_to(frame, view, geometry);
            self.surface_buffers(frame, view, &depth, geometry)
        })
    }

    /// Adds the pass for a technique that reads surfaces.
    pub(crate) fn surface_buffers<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &ViewBuffers,
        depth: &Texture,
        geometry: &Geometry<'f>,
    ) -> Result<SurfaceBuffers, Error> {
        let surfaces = self.add_to(frame, view, depth, geometry)?;
        let (view, lights) = (view.view.clone(), view.lights.clone());
        let has_blended = !geometry.draws.blend.is_empty();
        let size_px = geometry.size_px;
        Ok(SurfaceBuffers { size_px, view, lights, surfaces, has_blended, ground_height: None })
    }
}
