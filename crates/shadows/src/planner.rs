//! How a [`ShadowPlan`] is made.

use glam::{DMat3, DVec3};
use shadowgraph_scene::{Aabb, Camera};

use crate::select::{Candidate, Reach, Shape, candidate, main_light};
use crate::{
    CascadeFit, Error, MAP_ATLAS, MAP_CASCADES, MAX_ATLAS_TILES, MapPlan, OrthoFit, ShadowInputs,
    ShadowLight, ShadowPlan, ShadowView, Slice, SpotFit, TileLayout, TilePlan, TileRect, Unshadowed,
    UnshadowedReason, atlas_layout, cascade_layout, fit_cascades, slice_sphere, smallest_atlas_tile_px,
    split_distances,
};

/// A plan in the making.
pub(crate) struct Planner<'a> {
    inputs: ShadowInputs<'a>,
    reach: Reach<'a>,
    plan: ShadowPlan,
}

impl<'a> Planner<'a> {
    /// Checks the inputs.
    pub(crate) fn new(inputs: &ShadowInputs<'a>) -> Result<Self, Error> {
        let ShadowInputs { camera, aspect, settings, .. } = *inputs;
        settings.validate()?;
        if !(aspect.is_finite() && aspect > 0.0) {
            return Err(Error::Aspect(aspect));
        }
        if !camera.world_from_view.is_finite() {
            return Err(Error::Camera("placement"));
        }
        let distance_m = f64::from(settings.distance_m);
        let distance_m = camera.far().map_or(distance_m, |far| far.min(distance_m));
        let corners = camera.slice_corners_view(aspect, camera.near(), distance_m);
        if !corners.iter().all(|corner| corner.is_finite()) {
            return Err(Error::Camera("projection"));
        }
        let near_m = camera.near();
        // Not before the near plane, however small the scene.
        let fit_m = farthest_m(&inputs.casters.receivers(), camera).max(near_m * 1.01 + 1e-3).min(distance_m);
        let reach = Reach { camera, aspect, near_m, distance_m, fit_m };
        let plan = ShadowPlan::all_lit(inputs.lights.len(), settings);
        Ok(Self { inputs: *inputs, reach, plan })
    }

    /// Makes the plan.
    pub(crate) fn plan(mut self) -> ShadowPlan {
        let mut candidates = self.candidates();
        if let Some(main) = main_light(&candidates) {
            let main = candidates.remove(main);
            self.add_cascades(&main);
        }
        let chosen = self.choose_for_atlas(candidates);
        if !chosen.is_empty() {
            self.add_atlas(chosen);
        }
        self.plan.unshadowed.sort_by_key(|unshadowed| unshadowed.light);
        self.plan
    }

    fn skip(&mut self, light: u32, reason: UnshadowedReason) {
        self.plan.unshadowed.push(Unshadowed { light, reason });
    }

    fn candidates(&mut self) -> Vec<Candidate> {
        let no_caster = self.inputs.casters.bounds().is_empty();
        let mut candidates = Vec::new();
        for (light, source) in (0u32..).zip(self.inputs.lights).filter(|(_, source)| source.casts_shadow) {
            match candidate(light, source, &self.reach) {
                Ok(_) if no_caster => self.skip(light, UnshadowedReason::NoCasterInReach),
                Ok(_) if self.reach.is_empty() => self.skip(light, UnshadowedReason::OutOfReach),
                Ok(found) => candidates.push(found),
                Err(reason) => self.skip(light, reason),
            }
        }
        candidates
    }

    fn add_cascades(&mut self, main: &Candidate) {
        let Shape::Directional { light_from_world } = main.shape else { return };
        let settings = &self.inputs.settings.cascades;
        let layout = cascade_layout(settings.count as usize, settings.map_size_px);
        let fits = self.fit_cascades(light_from_world, layout.tile_px);
        let tiles: Vec<TilePlan> = (0u32..)
            .zip(fits.iter().zip(&layout.tiles))
            .map(|(cascade, (fit, &rect))| {
                let casters = self.cull(&TileFit::Directional(fit.fit));
                TilePlan { light: main.light, view: cascade, cascade: Some(cascade), rect, casters }
            })
            .collect();
        if tiles.iter().all(|tile| tile.casters.is_empty()) {
            return self.skip(main.light, UnshadowedReason::NoCasterInReach);
        }
        for (tile, fit) in tiles.iter().zip(&fits) {
            let origin_world = self.inputs.origin_world;
            let view = ShadowView::directional(&fit.fit, tile.rect, layout.size_px, origin_world);
            self.plan.views.push(ShadowView { cascade: tile.view, ..view });
        }
        self.set_light(main.light, MAP_CASCADES, 0, settings.count);
        self.plan.cascades = Some(MapPlan { size_px: layout.size_px, tiles });
    }

    fn fit_cascades(&self, light_from_world: DMat3, tile_px: u32) -> Vec<CascadeFit> {
        let Reach { camera, aspect, near_m, fit_m, .. } = self.reach;
        let settings = &self.inputs.settings.cascades;
        let ends = split_distances(&settings.split, settings.count, near_m, fit_m);
        fit_cascades(camera, aspect, &ends, light_from_world, tile_px, self.plan.needs.margin_px())
    }

    /// The lights that get a tile and their casters, in the scene's order: a light keeps its tile when
    /// importances change places.
    fn choose_for_atlas(&mut self, mut candidates: Vec<Candidate>) -> Vec<(Candidate, Vec<u32>)> {
        candidates.sort_by(Candidate::order);
        let smallest_px = smallest_atlas_tile_px(self.inputs.settings.atlas.map_size_px);
        let mut chosen: Vec<(Candidate, Vec<u32>)> = Vec::new();
        for candidate in candidates {
            if chosen.len() == MAX_ATLAS_TILES {
                self.skip(candidate.light, UnshadowedReason::AtlasFull);
                continue;
            }
            // The smallest tile has the widest margin: what its view misses, a larger tile's misses too.
            let casters = self.cull(&self.fit(&candidate.shape, smallest_px));
            if casters.is_empty() {
                self.skip(candidate.light, UnshadowedReason::NoCasterInReach);
            } else {
                chosen.push((candidate, casters));
            }
        }
        chosen.sort_by_key(|(candidate, _)| candidate.light);
        chosen
    }

    fn add_atlas(&mut self, chosen: Vec<(Candidate, Vec<u32>)>) {
        let TileLayout { size_px, tile_px, tiles } =
            atlas_layout(chosen.len(), self.inputs.settings.atlas.map_size_px);
        let mut planned = Vec::with_capacity(chosen.len());
        for ((candidate, casters), rect) in chosen.into_iter().zip(tiles) {
            let view = self.plan.views.len() as u32;
            let fit = self.fit(&candidate.shape, tile_px);
            self.plan.views.push(fit.view(rect, size_px, self.inputs.origin_world));
            self.set_light(candidate.light, MAP_ATLAS, view, 1);
            planned.push(TilePlan { light: candidate.light, view, cascade: None, rect, casters });
        }
        self.plan.atlas = Some(MapPlan { size_px, tiles: planned });
    }

    fn fit(&self, shape: &Shape, tile_px: u32) -> TileFit {
        let margin_px = self.plan.needs.margin_px();
        match *shape {
            Shape::Spot { cone, light_from_world } => {
                let near_m = f64::from(self.inputs.settings.atlas.spot_near_m);
                TileFit::Spot(SpotFit::new(cone, light_from_world, near_m, tile_px, margin_px))
            }
            Shape::Directional { light_from_world } => {
                let Reach { camera, aspect, near_m, fit_m, .. } = self.reach;
                let sphere = slice_sphere(&Slice { camera, aspect, near_m, far_m: fit_m });
                TileFit::Directional(OrthoFit::new(light_from_world, sphere, tile_px, margin_px))
            }
        }
    }

    fn cull(&self, fit: &TileFit) -> Vec<u32> {
        let volume = match fit {
            TileFit::Spot(fit) => fit.cull_volume(),
            TileFit::Directional(fit) => fit.cull_volume(),
        };
        let mut casters = Vec::new();
        self.inputs.casters.cull(&volume, &mut casters);
        casters
    }

    fn set_light(&mut self, light: u32, map: u32, first_view: u32, view_count: u32) {
        let settings = self.inputs.settings;
        self.plan.lights[light as usize] =
            ShadowLight { map, first_view, view_count, ..ShadowLight::new(settings, self.reach.distance_m) };
    }
}

/// How far it is from the camera to the farthest point of the bounds, metres, rounded up to one of four steps per factor
/// of two: it does not change as the camera turns, and rarely as it moves. Infinite for bounds of nothing.
fn farthest_m(bounds: &Aabb, camera: &Camera) -> f64 {
    if bounds.is_empty() {
        return f64::INFINITY;
    }
    let eye = camera.position_world();
    let farthest = bounds.corners().map(|corner| corner.distance(eye)).into_iter().fold(0.0, f64::max);
    ((farthest.log2() * 4.0).ceil() / 4.0).exp2()
}

/// What a tile covers.
enum TileFit {
    Spot(SpotFit),
    Directional(OrthoFit),
}

impl TileFit {
    fn view(&self, rect: TileRect, map_size_px: [u32; 2], origin_world: DVec3) -> ShadowView {
        match self {
            Self::Spot(fit) => ShadowView::spot(fit, rect, map_size_px, origin_world),
            Self::Directional(fit) => ShadowView::directional(fit, rect, map_size_px, origin_world),
        }
    }
}
