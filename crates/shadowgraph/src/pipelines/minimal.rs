//! `minimal`: shadows, one lit pass without a depth prepass, a tonemap.

use shadowgraph_core::Frame;
use shadowgraph_lighting::{Forward as Lighting, Tonemap};

use super::{Build, Output, View, Wiring};
use crate::Error;
use crate::surfaces::SurfaceDrawer;

/// What `minimal` keeps from frame to frame.
pub struct Minimal {
    surfaces: Option<SurfaceDrawer>,
    lighting: Lighting,
    tonemap: Tonemap,
}

impl Minimal {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        let reads = build.technique.reads_surface_buffers();
        Ok(Self {
            surfaces: reads.then(|| SurfaceDrawer::new(build.device, build.layouts)).transpose()?,
            lighting: Lighting::new(build.device, build.layouts, build.technique, build.lit)?,
            tonemap: Tonemap::new(build.device)?,
        })
    }
}

impl Wiring for Minimal {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let buffers = view.uniforms().upload(frame);
        let geometry = view.geometry();

        // A technique that asks for surfaces needs them before anything is lit.
        let screen = self.surfaces.as_ref().map(|drawer| drawer.screen_alone(frame, &buffers, geometry));

        // Shadows, by whatever technique.
        let shadows = view.shadows(frame, screen.transpose()?.as_ref())?;

        // The lit scene.
        let (light, depth) = frame.node("lighting", |frame| {
            self.lighting.lit_without_prepass(frame, &buffers, &shadows, geometry, view.background())
        })?;

        // The picture.
        let picture = view.tonemapped(frame, &self.tonemap, &light);
        Ok(Output { picture, light: Some(light), depth: Some(depth), view: Some(buffers), shadows })
    }
}
