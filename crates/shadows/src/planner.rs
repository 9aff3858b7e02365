//! Construction of a [`ShadowPlan`].

mod atlas;
mod cascades;
mod culling;

use shadowgraph_scene::{Aabb, Camera, CullVolume};

use culling::VisibleReceivers;

use crate::allocation::AtlasAllocation;
use crate::atlas::TileRect;
use crate::error::Error;
use crate::light_params::{self, LightShadowParams};
use crate::plan::{ShadowInputs, ShadowPlan};
use crate::requirements::Requirements;
use crate::select::{Candidate, ShadowRange, Shape, candidate};
use crate::select::{Unshadowed, UnshadowedReason};
use crate::settings::LightShadows;
use crate::views::{ShadowLight, TilePlacement};

/// A plan under construction.
pub(crate) struct Planner<'a> {
    inputs: ShadowInputs<'a>,
    range: ShadowRange<'a>,
    visible: VisibleReceivers,
    /// The individual settings of each light of the scene.
    own: Vec<Option<&'a LightShadows>>,
    /// The tiles of the previous frame.
    previous: Option<&'a AtlasAllocation>,
    /// The technique's requirements.
    requirements: Requirements,
    plan: ShadowPlan,
}

impl<'a> Planner<'a> {
    /// Validates the inputs.
    pub(crate) fn new(
        inputs: &ShadowInputs<'a>,
        previous: Option<&'a AtlasAllocation>,
        requirements: &Requirements,
    ) -> Result<Self, Error> {
        let ShadowInputs { camera, aspect, settings, .. } = *inputs;
        settings.validate()?;
        let own = light_params::of_lights(settings, inputs.lights)?;
        camera.check(aspect)?;
        let distance_m = f64::from(settings.distance_m);
        let distance_m = camera.far().map_or(distance_m, |far| far.min(distance_m));
        let near_m = camera.near();
        // Never in front of the near plane, however small the scene.
        let fit_m = farthest_m(&inputs.casters.receivers(), camera).max(near_m * 1.01 + 1e-3).min(distance_m);
        let range = ShadowRange { camera, aspect, near_m, distance_m, fit_m };
        let plan = ShadowPlan::all_lit(inputs.lights.len(), settings);
        let visible = VisibleReceivers::new(inputs, &range);
        Ok(Self { inputs: *inputs, range, visible, own, previous, requirements: *requirements, plan })
    }

    /// Builds the plan.
    pub(crate) fn plan(mut self) -> ShadowPlan {
        let mut candidates = self.candidates();
        candidates.sort_by(Candidate::order);
        let (count, lights) = (self.inputs.settings.cascades.count, self.inputs.settings.cascades.lights);
        let is_directional = |c: &&Candidate<'_>| matches!(c.shape, Shape::Directional { .. });
        let directional = candidates.iter().take_while(is_directional).count();
        let with_cascades = if count == 0 { 0 } else { directional.min(lights as usize) };
        let others = candidates.split_off(with_cascades);
        self.add_cascades(candidates);
        self.add_atlas(others);
        self.plan.unshadowed.sort_by_key(|unshadowed| unshadowed.light);
        self.plan
    }

    fn reject(&mut self, light: u32, reason: UnshadowedReason) {
        self.plan.unshadowed.push(Unshadowed { light, reason });
    }

    fn candidates(&mut self) -> Vec<Candidate<'a>> {
        let no_caster = self.inputs.casters.bounds().is_empty();
        let mut candidates = Vec::new();
        for (light, source) in (0u32..).zip(self.inputs.lights) {
            let own = self.own[light as usize];
            if !source.casts_shadow || own.is_some_and(|own| !own.casts || own.strength == 0.0) {
                continue;
            }
            match candidate(light, source, own, &self.range) {
                Ok(_) if no_caster => self.reject(light, UnshadowedReason::NoCasterInRange),
                Ok(_) if self.range.is_empty() => self.reject(light, UnshadowedReason::OutOfView),
                Ok(found) => candidates.push(found),
                Err(reason) => self.reject(light, reason),
            }
        }
        candidates
    }

    fn light_params(&self, candidate: &Candidate<'_>, has_cascades: bool) -> LightShadowParams {
        LightShadowParams::new(self.inputs.settings, candidate.own, has_cascades)
            .with_requirements(&self.requirements)
    }

    fn cull(&self, volume: &CullVolume) -> Vec<u32> {
        let mut casters = Vec::new();
        self.inputs.casters.cull(volume, &mut casters);
        casters
    }

    /// Splits casters into opaque and tinting ones.
    fn opaque_and_tints(&self, casters: Vec<u32>) -> (Vec<u32>, Vec<u32>) {
        let tints = |caster: &u32| self.inputs.casters.tints(*caster);
        if !casters.iter().any(tints) {
            return (casters, Vec::new());
        }
        casters.into_iter().partition(|caster| !tints(caster))
    }

    /// Assigns a light its views, and returns its struct for further changes.
    fn set_light(
        &mut self,
        light: u32,
        params: &LightShadowParams,
        (map, first_view, view_count): (u32, u32, u32),
    ) -> &mut ShadowLight {
        let gpu_light = &mut self.plan.lights[light as usize];
        let distance_m = self.range.distance_m;
        *gpu_light =
            ShadowLight { map, first_view, view_count, ..ShadowLight::with_params(params, distance_m) };
        gpu_light
    }
}

/// Returns the placement of a tile.
fn placement(
    rect: TileRect,
    map_size_px: [u32; 2],
    params: &LightShadowParams,
    depth_step: f32,
) -> TilePlacement {
    TilePlacement { rect, map_size_px, border_px: params.border_px(), depth_step }
}

/// Returns the distance from the camera to the farthest point of the bounds, metres, rounded up to one of four steps per
/// factor of two: it does not change as the camera turns, and rarely as it moves. Infinite for empty bounds.
fn farthest_m(bounds: &Aabb, camera: &Camera) -> f64 {
    if bounds.is_empty() {
        return f64::INFINITY;
    }
    let eye = camera.position_world();
    let farthest = bounds.corners().map(|corner| corner.distance(eye)).into_iter().fold(0.0, f64::max);
    ((farthest.log2() * 4.0).ceil() / 4.0).exp2()
}
