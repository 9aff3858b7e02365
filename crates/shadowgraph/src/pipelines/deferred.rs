//! `deferred`: a depth prepass, a G-buffer, shadows, each pixel lit once, what is blended over it, a tonemap.

use shadowgraph_core::Frame;
use shadowgraph_lighting::{Clusters, Deferred as Lighting, Forward, GBufferPass, Tonemap};

use super::{Build, Output, View, Wiring};
use crate::Error;
use crate::nodes::GeometryNode;

/// What `deferred` keeps from frame to frame.
pub struct Deferred {
    geometry: GeometryNode,
    gbuffer: GBufferPass,
    clusters: Clusters,
    lighting: Lighting,
    /// For what is blended.
    forward: Forward,
    tonemap: Tonemap,
}

impl Deferred {
    /// Makes the pipelines.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose, and for several samples a pixel.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        Ok(Self {
            geometry: GeometryNode::new(build)?,
            gbuffer: GBufferPass::new(build.device, build.layouts)?,
            clusters: Clusters::new(build.device)?,
            lighting: Lighting::new(build.device, build.technique, build.lit)?,
            forward: Forward::new(build.device, build.layouts, build.technique, build.lit)?,
            tonemap: Tonemap::new(build.device)?,
        })
    }
}

impl Wiring for Deferred {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let buffers = view.uniforms().upload(frame);
        let geometry = view.geometry();

        // What is seen: its depth, then its colours, materials and normals.
        let (depth, screen) = frame.node("geometry", |frame| self.geometry.add_to(frame, view, &buffers))?;
        let gbuffer = frame.node("gbuffer", |frame| self.gbuffer.add_to(frame, &buffers, &depth, geometry));

        // Shadows, by whatever technique, and which lights reach which part of the view.
        let shadows = view.shadows(frame, screen.as_ref())?;
        let count = view.lights.len();
        let clustered = frame.node("clusters", |frame| self.clusters.add_to(frame, &buffers, count));

        // Each pixel lit once, and what is blended over it.
        let light = frame.node("lighting", |frame| {
            let sky = view.background();
            let mut light = self.lighting.add_to(frame, &clustered, &shadows, &depth, &gbuffer, sky)?;
            self.forward.blended(frame, &clustered, &shadows, &depth, geometry, &mut light)?;
            Ok::<_, Error>(light)
        })?;

        // The picture.
        let picture = view.tonemapped(frame, &self.tonemap, &light);
        Ok(Output { picture, light: Some(light), depth: Some(depth), view: Some(buffers), shadows })
    }
}
