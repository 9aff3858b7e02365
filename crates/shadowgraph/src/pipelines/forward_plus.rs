//! `forward_plus`: as `forward`, and each pixel asks only the lights that reach its part of the view.

use shadowgraph_core::Frame;
use shadowgraph_lighting::{Clusters, Forward as Lighting, Tonemap};

use super::{Build, Output, View, Wiring};
use crate::Error;
use crate::nodes::GeometryNode;

/// What `forward_plus` keeps from frame to frame.
pub struct ForwardPlus {
    geometry: GeometryNode,
    clusters: Clusters,
    lighting: Lighting,
    tonemap: Tonemap,
}

impl ForwardPlus {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        Ok(Self {
            geometry: GeometryNode::new(build)?,
            clusters: Clusters::new(build.device)?,
            lighting: Lighting::new(build.device, build.layouts, build.technique, build.lit)?,
            tonemap: Tonemap::new(build.device)?,
        })
    }
}

impl Wiring for ForwardPlus {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let buffers = view.uniforms().upload(frame);
        let (depth, screen) = frame.node("geometry", |frame| self.geometry.add_to(frame, view, &buffers))?;
        let shadows = view.shadows(frame, screen.as_ref())?;

        // Which lights reach which part of the view.
        let count = view.lights.len();
        let clustered = frame.node("clusters", |frame| self.clusters.add_to(frame, &buffers, count));

        // The lit scene.
        let (geometry, sky) = (view.geometry(), view.background());
        let light = frame.node("lighting", |frame| {
            self.lighting.lit(frame, &clustered, &shadows, &depth, geometry, sky)
        })?;

        // The picture.
        let picture = view.tonemapped(frame, &self.tonemap, &light);
        Ok(Output { picture, light: Some(light), depth: Some(depth), view: Some(buffers), shadows })
    }
}
