//! The atlas.

use super::{Planner, place};
use crate::rules::LightRules;
use crate::select::{Candidate, Reach, Shape, point_face};
use crate::views::SELECT_FACE;
use crate::{
    MAP_ATLAS, MAX_ATLAS_TILES, MapPlan, OrthoFit, ShadowView, Slice, SpotFit, TileLayout, TilePart,
    TilePlace, TilePlan, UnshadowedReason, even_tiles, slice_sphere, smallest_atlas_tile_px,
};

/// A light of the atlas, and the casters of each of its tiles.
struct Chosen<'s> {
    candidate: Candidate<'s>,
    rules: LightRules,
    casters: Vec<Vec<u32>>,
}

impl<'a> Planner<'a> {
    /// Gives tiles to lights, the most important (in front) first.
    pub(super) fn add_atlas(&mut self, candidates: Vec<Candidate<'a>>) {
        let chosen = self.choose(candidates);
        if chosen.is_empty() {
            return;
        }
        let settings = &self.inputs.settings.atlas;
        let count = chosen.iter().map(|chosen| chosen.casters.len()).sum();
        let TileLayout { size_px, tile_px, tiles } = even_tiles(count, settings.map_size_px);
        let mut map = MapPlan { size_px, depth: settings.depth, tiles: Vec::new() };
        let mut rects = tiles.into_iter();
        for Chosen { candidate, rules, casters } in chosen {
            let first_view = self.plan.views.len() as u32;
            let views = (MAP_ATLAS, first_view, casters.len() as u32);
            let is_point = casters.len() > 1;
            if is_point {
                self.set_light(candidate.light, &rules, views).select = SELECT_FACE;
            } else {
                self.set_light(candidate.light, &rules, views);
            }
            for ((index, casters), rect) in (0u32..).zip(casters).zip(&mut rects) {
                let fit = self.fit(&candidate.shape, index as usize, tile_px, &rules);
                let tile = place(rect, size_px, &rules, settings.depth.step());
                self.plan.views.push(fit.view(&tile, self.inputs.origin_world));
                let part = if is_point { TilePart::Face(index) } else { TilePart::Whole };
                let (light, view) = (candidate.light, first_view + index);
                map.tiles.push(TilePlan { light, view, part, rect, casters });
            }
        }
        self.plan.atlas = Some(map);
    }

    /// The lights that get tiles and their casters, in the scene's order: a light keeps its tile when
    /// importances change places.
    fn choose(&mut self, candidates: Vec<Candidate<'a>>) -> Vec<Chosen<'a>> {
        let smallest_px = smallest_atlas_tile_px(self.inputs.settings.atlas.map_size_px);
        let mut chosen: Vec<Chosen<'a>> = Vec::new();
        let mut free = MAX_ATLAS_TILES;
        for candidate in candidates {
            let tiles = candidate.shape.tiles();
            if tiles > free {
                // Less important lights do not get what is left.
                free = 0;
                self.skip(candidate.light, UnshadowedReason::AtlasFull);
                continue;
            }
            let rules = self.rules(&candidate, false);
            // The smallest tile has the widest margin: what its view misses, a larger tile's misses too.
            let cull = |tile| self.fit(&candidate.shape, tile, smallest_px, &rules).cull(self);
            let casters: Vec<Vec<u32>> = (0..tiles).map(cull).collect();
            if casters.iter().all(Vec::is_empty) {
                self.skip(candidate.light, UnshadowedReason::NoCasterInReach);
            } else {
                free -= tiles;
                chosen.push(Chosen { candidate, rules, casters });
            }
        }
        chosen.sort_by_key(|chosen| chosen.candidate.light);
        chosen
    }

    fn fit(&self, shape: &Shape, tile: usize, tile_px: u32, rules: &LightRules) -> TileFit {
        let margin_px = rules.margin_px(1.0);
        let near_m = rules.near_m.unwrap_or(f64::from(self.inputs.settings.atlas.spot_near_m));
        let spot = |(cone, light_from_world)| {
            TileFit::Spot(SpotFit::new(cone, light_from_world, near_m, tile_px, margin_px))
        };
        match *shape {
            Shape::Spot { cone, light_from_world } => spot((cone, light_from_world)),
            Shape::Point { position_world, range_m } => spot(point_face(position_world, range_m, tile)),
            Shape::Directional { light_from_world } => {
                let Reach { camera, aspect, near_m, fit_m, .. } = self.reach;
                let sphere = slice_sphere(&Slice { camera, aspect, near_m, far_m: fit_m });
                let fit = OrthoFit::new(light_from_world, sphere, tile_px, margin_px);
                TileFit::Directional(fit.with_near_offset(rules.near_m.unwrap_or(0.0)))
            }
        }
    }
}

/// What a tile covers.
enum TileFit {
    Spot(SpotFit),
    Directional(OrthoFit),
}

impl TileFit {
    fn view(&self, tile: &TilePlace, origin_world: glam::DVec3) -> ShadowView {
        match self {
            Self::Spot(fit) => ShadowView::spot(fit, tile, origin_world),
            Self::Directional(fit) => ShadowView::directional(fit, tile, origin_world),
        }
    }

    fn cull(&self, planner: &Planner<'_>) -> Vec<u32> {
        match self {
            Self::Spot(fit) => planner.cull(&fit.cull_volume()),
            Self::Directional(fit) => planner.cull(&fit.cull_volume()),
        }
    }
}
