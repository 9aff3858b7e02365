//! The geometry that a view draws.

use shadowgraph_core::{Error as GraphError, Pass, RenderContext, Rendering};
use shadowgraph_scene::gpu::{AlphaKey, Draw, DrawList, DrawPipeline, GpuScene};
use shadowgraph_shadows::{CulledInstances, CulledTokens};

use crate::culling::draw_culled;

/// The geometry that a view draws.
#[derive(Clone)]
pub struct Geometry<'f> {
    /// The scene on the GPU.
    pub scene: &'f GpuScene,
    /// The visible draws; only the blended ones if the GPU has culled the others.
    pub draws: &'f DrawList,
    /// What the GPU has culled.
    pub culled: Option<CulledGeometry>,
    /// Width and height of the image, pixels.
    pub size_px: [u32; 2],
}

/// The geometry of a view that the GPU has culled.
#[derive(Clone)]
pub struct CulledGeometry {
    /// The culled instances.
    pub instances: CulledInstances,
    /// The view of the visible instances that are not blended.
    pub solid: u32,
    /// The view of those that move, if any do.
    pub moving: Option<u32>,
}

/// Draws of a pass: those of a list, or those that the GPU has culled.
pub(crate) struct Draws<'f> {
    scene: &'f GpuScene,
    listed: Vec<&'f Draw>,
    culled: Option<CulledTokens>,
}

impl<'f> Geometry<'f> {
    /// Declares that a pass draws all geometry that is not blended.
    pub(crate) fn solid_in(&self, pass: &mut Pass<'_, 'f, Rendering>) -> Draws<'f> {
        let view = self.culled.as_ref().map(|culled| (culled, culled.solid));
        self.draws_in(pass, view, |_| true)
    }

    /// Returns whether any geometry moves that is not blended.
    pub(crate) fn has_moving(&self) -> bool {
        match &self.culled {
            Some(culled) => culled.moving.is_some(),
            None => self.draws.solid.iter().any(|draw| self.scene.is_moving(draw.instance)),
        }
    }

    /// Declares that a pass draws the geometry that moves and is not blended.
    pub(crate) fn moving_in(&self, pass: &mut Pass<'_, 'f, Rendering>) -> Draws<'f> {
        let view = self.culled.as_ref().and_then(|culled| Some((culled, culled.moving?)));
        self.draws_in(pass, view, |draw| self.scene.is_moving(draw.instance))
    }

    fn draws_in(
        &self,
        pass: &mut Pass<'_, 'f, Rendering>,
        view: Option<(&CulledGeometry, u32)>,
        is_wanted: impl Fn(&Draw) -> bool,
    ) -> Draws<'f> {
        let culled = view.and_then(|(culled, view)| culled.instances.read_in(pass, view));
        let listed = self.draws.solid.iter().filter(|draw| is_wanted(draw)).collect();
        Draws { scene: self.scene, listed, culled }
    }
}

impl Draws<'_> {
    /// Records the draws.
    ///
    /// # Errors
    /// For another pass than that in which they were declared.
    pub(crate) fn record<'p>(
        &self,
        ctx: &mut RenderContext<'_>,
        pipeline_for: &dyn Fn(&Draw) -> Option<DrawPipeline<'p>>,
    ) -> Result<(), GraphError> {
        let listed = self.listed.iter().copied();
        let mut draws = self.scene.draw(&mut ctx.pass, listed, pipeline_for);
        if let Some(culled) = self.culled {
            let is_solid = |draw: &Draw| draw.key.alpha != AlphaKey::Blend;
            let solid = |draw: &Draw| is_solid(draw).then(|| pipeline_for(draw)).flatten();
            draws += draw_culled(ctx, self.scene, culled, &solid)?;
        }
        ctx.report_draws(draws);
        Ok(())
    }
}
