//! `forward`: a depth prepass, shadows, one lit pass, a tonemap.
//!
//! `screen_shadows` is the same with shadows that are collected in a screen mask.

use shadowgraph_core::Frame;
use shadowgraph_lighting::{Forward as Lighting, Tonemap};

use super::{Build, Output, View, Wiring};
use crate::Error;
use crate::nodes::GeometryNode;

/// What `forward` keeps from frame to frame.
pub struct Forward {
    geometry: GeometryNode,
    lighting: Lighting,
    tonemap: Tonemap,
}

impl Forward {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        Ok(Self {
            geometry: GeometryNode::new(build)?,
            lighting: Lighting::new(build.device, build.layouts, build.technique, build.lit)?,
            tonemap: Tonemap::new(build.device)?,
        })
    }
}

impl Wiring for Forward {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        // The camera and the lights, for every shader.
        let buffers = view.uniforms().upload(frame);

        // What is seen: its depth, and where the technique asks for it, its surfaces.
        let (depth, screen) = frame.node("geometry", |frame| self.geometry.add_to(frame, view, &buffers))?;

        // Shadows, by whatever technique.
        let shadows = view.shadows(frame, screen.as_ref())?;

        // The lit scene.
        let (geometry, sky) = (view.geometry(), view.background());
        let light = frame
            .node("lighting", |frame| self.lighting.lit(frame, &buffers, &shadows, &depth, geometry, sky))?;

        // The picture.
        let picture = view.tonemapped(frame, &self.tonemap, &light);
        Ok(Output { picture, light: Some(light), depth: Some(depth), view: Some(buffers), shadows })
    }
}
