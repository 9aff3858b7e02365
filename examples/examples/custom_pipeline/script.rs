//! The pipeline of `pipeline.ron` in Rust.

use crate::vignette::Vignette;
use shadowgraph::core::{Format, Frame};
use shadowgraph::lighting::post::{Bloom, Jitters, Occlusion, OcclusionSettings, Temporal};
use shadowgraph::lighting::{Forward, SkyLight, SkySettings, Tonemap, Velocity};
use shadowgraph::nodes::GeometryNode;
use shadowgraph::pipelines::{PipelineInstance, PipelineOutput};
use shadowgraph::{BuildContext, Error, RenderView};

/// The state that the pipeline keeps from frame to frame. A frame is one call per node.
pub(crate) struct Script {
    jitters: Jitters,
    geometry: GeometryNode,
    velocity: Velocity,
    occlusion: Occlusion,
    lighting: Forward,
    temporal: Temporal,
    bloom: Bloom,
    vignette: Vignette,
    tonemap: Tonemap,
}

impl Script {
    pub(crate) fn new(context: &BuildContext<'_>) -> Result<Self, Error> {
        Ok(Self {
            jitters: Jitters::default(),
            geometry: GeometryNode::new(context)?,
            velocity: Velocity::new(context.device, context.layouts)?,
            occlusion: Occlusion::new(context.device)?,
            lighting: Forward::new(context.device, context.layouts, context.technique, context.lit)?,
            temporal: Temporal::new(context.device)?,
            bloom: Bloom::new(context.device)?,
            vignette: Vignette::with_strength(0.6),
            tonemap: Tonemap::new(context.device)?,
        })
    }
}

impl PipelineInstance for Script {
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
    ) -> Result<PipelineOutput<'f>, Error> {
        let geometry = &view.geometry(frame);
        let light =
            |frame: &mut Frame<'f>| frame.create_texture("light", view.texture_desc(Format::Rgba16Float));

        let buffers = view.uniforms().jittered(self.jitters.next(view.index)).upload(frame);
        let sky = SkyLight::new(view.lights, view.key_light, &SkySettings::default());
        let buffers = frame.node("sky", |frame| view.with_sky(frame, &buffers, &sky));
        let (depth, surfaces, velocity) = frame.node("geometry", |frame| {
            let (depth, surfaces) = self.geometry.add_to(frame, view, &buffers)?;
            let velocity = self.velocity.add_to(frame, &buffers, &depth, geometry);
            Ok::<_, Error>((depth, surfaces, velocity))
        })?;
        let shadows = view.add_shadows(frame, surfaces.as_ref())?;
        let occluded = frame.node("occlusion", |frame| {
            self.occlusion.add_to(frame, &buffers, &depth, &OcclusionSettings::default())
        });
        let lit = frame.node("lighting", |frame| {
            self.lighting.lit(frame, &occluded, &shadows, &depth, geometry, view.clear_color())
        })?;
        let accumulated = frame.node("temporal", |frame| {
            self.temporal.add_to(frame, [&lit, &depth], Some(&velocity), &buffers, 0.1)
        });
        let bloomed = frame.node("bloom", |frame| {
            let mut target = light(frame);
            self.bloom.add_to(frame, &accumulated, &mut target, 0.06, 6);
            target
        });
        let darker = frame.node("vignette", |frame| {
            let mut target = light(frame);
            self.vignette.draw(frame, &bloomed, &mut target);
            target
        });
        let image = view.add_tonemap(frame, &self.tonemap, &darker);
        Ok(PipelineOutput { image, light: Some(lit), depth: Some(depth), view: Some(buffers), shadows })
    }

    fn is_temporal(&self) -> bool {
        true
    }
}
