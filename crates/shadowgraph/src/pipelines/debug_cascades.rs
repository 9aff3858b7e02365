//! `debug_cascades`: as `forward`, with the technique's debug colours over the picture.

use shadowgraph_core::{Format, Frame};
use shadowgraph_lighting::post::Overlay;
use shadowgraph_lighting::{Forward as Lighting, LitOutput, LitTarget, Tonemap};

use super::{Build, Output, View, Wiring};
use crate::Error;
use crate::nodes::GeometryNode;

/// What `debug_cascades` keeps from frame to frame.
pub struct DebugCascades {
    geometry: GeometryNode,
    lighting: Lighting,
    debug: Lighting,
    tonemap: Tonemap,
    overlay: Overlay,
}

impl DebugCascades {
    /// How strong the colours are.
    const STRENGTH: f32 = 0.5;

    /// Makes the pipelines.
    ///
    /// # Errors
    /// If the technique's WGSL does not compose.
    pub fn new(build: &Build<'_>) -> Result<Self, Error> {
        let Build { device, layouts, technique, lit } = *build;
        let debug = LitTarget { format: Format::Rgba8Unorm, output: LitOutput::Debug, ..lit };
        Ok(Self {
            geometry: GeometryNode::new(build)?,
            lighting: Lighting::new(device, layouts, technique, lit)?,
            debug: Lighting::new(device, layouts, technique, debug)?,
            tonemap: Tonemap::new(device)?,
            overlay: Overlay::new(device)?,
        })
    }
}

impl Wiring for DebugCascades {
    fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Output<'f>, Error> {
        let buffers = view.uniforms().upload(frame);
        let (depth, screen) = frame.node("geometry", |frame| self.geometry.add_to(frame, view, &buffers))?;
        let shadows = view.shadows(frame, screen.as_ref())?;

        // The lit scene, and what the technique tells of itself.
        let (geometry, sky) = (view.geometry(), view.background());
        let light = frame
            .node("lighting", |frame| self.lighting.lit(frame, &buffers, &shadows, &depth, geometry, sky))?;
        let colors = frame
            .node("debug", |frame| self.debug.lit(frame, &buffers, &shadows, &depth, geometry, [0.0; 4]))?;

        // The picture, and the colours over it.
        let plain = frame.node("picture", |frame| {
            let mut plain = frame.create_texture("picture", view.texture_desc(Format::Rgba8UnormSrgb));
            self.tonemap.add_to(frame, &light, &mut plain);
            plain
        });
        let picture = frame.node("overlay", |frame| {
            let mut picture = view.picture(frame);
            self.overlay.add_to(frame, [&plain, &colors], &mut picture, Self::STRENGTH);
            picture
        });
        Ok(Output { picture, light: Some(light), depth: Some(depth), view: Some(buffers), shadows })
    }
}
