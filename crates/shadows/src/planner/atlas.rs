//! Planning of the atlas.

use super::{Planner, placement};
use crate::allocation::{AtlasConfig, TileRequest, allocate_tiles};
use crate::atlas::{MAX_ATLAS_TILES, TileRect, even_tiles, smallest_atlas_tile_px};
use crate::caster_view::TileKind;
use crate::light_params::LightShadowParams;
use crate::ortho::OrthoFit;
use crate::plan::{MapPlan, TilePlan};
use crate::select::UnshadowedReason;
use crate::select::{Candidate, Shape, point_face};
use crate::settings::AtlasTiles;
use crate::spot::SpotFit;
use crate::tile_fit::TileFit;
use crate::views::{MAP_ATLAS, ShadowView, TilePlacement};
use crate::views::{SELECT_FACE, SELECT_MAP};

/// Doublings of a tile beyond what the light requests: the map would be empty there.
const MAX_GROWTH: u32 = 2;

/// The request of a light that casts shadows, with the casters of each of its tiles.
struct Request<'s> {
    candidate: Candidate<'s>,
    params: LightShadowParams,
    casters: Vec<Vec<u32>>,
}

/// The tiles of a light in the map.
struct Tiles {
    map_size_px: [u32; 2],
    tile_px: u32,
    rects: Vec<TileRect>,
}

impl<'a> Planner<'a> {
    /// Assigns tiles to lights. `candidates` begin with the most important one.
    pub(super) fn add_atlas(&mut self, candidates: Vec<Candidate<'a>>) {
        let requests = self.requests(candidates);
        let chosen = match self.inputs.settings.atlas.tiles {
            AtlasTiles::Even => self.even(requests),
            AtlasTiles::ByImportance { smallest_px } => self.by_importance(requests, smallest_px),
        };
        let Some((_, first)) = chosen.first() else { return };
        let settings = &self.inputs.settings.atlas;
        let mut map = MapPlan {
            size_px: first.map_size_px,
            depth: settings.depth,
            cache: settings.cache,
            tiles: Vec::new(),
        };
        for (light, tiles) in chosen {
            map.tiles.extend(self.add_local(light, tiles));
        }
        self.plan.atlas = Some(map);
    }

    /// Returns the requests of the lights that have casters.
    fn requests(&mut self, candidates: Vec<Candidate<'a>>) -> Vec<Request<'a>> {
        let smallest_px = match self.inputs.settings.atlas.tiles {
            AtlasTiles::Even => smallest_atlas_tile_px(self.inputs.settings.atlas.map_size_px),
            AtlasTiles::ByImportance { smallest_px } => smallest_px,
        };
        let mut requests = Vec::new();
        for candidate in candidates {
            let params = self.light_params(&candidate, false);
            // The smallest tile has the widest margin: casters outside its view are outside a larger tile's too.
            let cull = |tile| self.fit(&candidate.shape, tile, smallest_px, &params).cull(self, &params);
            let casters: Vec<Vec<u32>> = (0..candidate.shape.tiles()).map(cull).collect();
            if casters.iter().all(Vec::is_empty) {
                self.reject(candidate.light, UnshadowedReason::NoCasterInRange);
            } else {
                requests.push(Request { candidate, params, casters });
            }
        }
        requests
    }

    /// Assigns tiles of one size to as many lights as fit, in the scene's order: lights keep their tiles when their ranks
    /// change.
    fn even(&mut self, requests: Vec<Request<'a>>) -> Vec<(Request<'a>, Tiles)> {
        let mut free = MAX_ATLAS_TILES;
        let mut chosen = Vec::new();
        for light in requests {
            if light.casters.len() <= free {
                free -= light.casters.len();
                chosen.push(light);
            } else {
                // Less important lights do not get the remaining tiles.
                free = 0;
                self.reject(light.candidate.light, UnshadowedReason::AtlasFull);
            }
        }
        chosen.sort_by_key(|light| light.candidate.light);
        let count = chosen.iter().map(|light| light.casters.len()).sum();
        let layout = even_tiles(count, self.inputs.settings.atlas.map_size_px);
        let mut rects = layout.tiles.into_iter();
        let tiles = |count| Tiles {
            map_size_px: layout.size_px,
            tile_px: layout.tile_px,
            rects: rects.by_ref().take(count).collect(),
        };
        let counts: Vec<usize> = chosen.iter().map(|light| light.casters.len()).collect();
        chosen.into_iter().zip(counts.into_iter().map(tiles)).collect()
    }

    /// Assigns tiles with sizes by the importance of the lights.
    fn by_importance(
        &mut self,
        mut requests: Vec<Request<'a>>,
        smallest_px: u32,
    ) -> Vec<(Request<'a>, Tiles)> {
        let map_px = self.inputs.settings.atlas.map_size_px;
        let config = AtlasConfig { map_px, smallest_px, largest_px: map_px, growth: MAX_GROWTH };
        let tile_requests: Vec<TileRequest> = (0u32..)
            .zip(&requests)
            .map(|(rank, light)| TileRequest {
                owner: light.candidate.light,
                tiles: light.casters.len() as u32,
                size_px: f64::from(map_px) * light.candidate.coverage().min(1.0),
                importance: -f64::from(rank),
            })
            .collect();
        let previous = self.previous.map(|previous| &previous.atlas_allocation);
        self.plan.state.atlas_allocation = allocate_tiles(&config, &tile_requests, previous);
        for &light in &self.plan.state.atlas_allocation.rejected.clone() {
            self.reject(light, UnshadowedReason::AtlasFull);
        }
        requests.sort_by_key(|light| light.candidate.light);
        let tiles = |light: Request<'a>| {
            let entry = self.plan.state.atlas_allocation.for_owner(light.candidate.light)?;
            let rects = self.plan.state.atlas_allocation.rects_for(light.candidate.light).to_vec();
            Some((light, Tiles { map_size_px: [map_px; 2], tile_px: entry.tile_px, rects }))
        };
        requests.into_iter().filter_map(tiles).collect()
    }

    /// Adds a light's views, and returns its tiles.
    fn add_local(&mut self, light: Request<'_>, tiles: Tiles) -> Vec<TilePlan> {
        let Request { candidate, params, casters } = light;
        let depth_step = self.inputs.settings.atlas.depth.step();
        let first_view = self.plan.views.len() as u32;
        let is_point = casters.len() > 1;
        let gpu_light =
            self.set_light(candidate.light, &params, (MAP_ATLAS, first_view, casters.len() as u32));
        gpu_light.select = if is_point { SELECT_FACE } else { SELECT_MAP };
        let mut planned = Vec::new();
        for ((index, casters), rect) in (0u32..).zip(casters).zip(tiles.rects) {
            let fit = self.fit(&candidate.shape, index as usize, tiles.tile_px, &params);
            let tile = placement(rect, tiles.map_size_px, &params, depth_step);
            let (casters, tints) = self.opaque_and_tints(casters);
            let is_tinted = u32::from(!tints.is_empty());
            let is_open = matches!(&fit, TileFit::Directional(fit) if self.range.is_whole(fit));
            let view = fit.view(&tile, self.inputs.origin_world);
            self.plan.views.push(ShadowView { is_tinted, is_open: u32::from(is_open), ..view });
            let kind = if is_point { TileKind::Face(index) } else { TileKind::Whole };
            let (light, view) = (candidate.light, first_view + index);
            let slope_bias_milli = params.slope_bias_milli(1.0);
            planned.push(TilePlan {
                light,
                view,
                kind,
                rect,
                fit,
                slope_bias_milli,
                casters,
                culled: None,
                tints,
            });
        }
        planned
    }

    fn fit(&self, shape: &Shape, tile: usize, tile_px: u32, params: &LightShadowParams) -> TileFit {
        let margin_px = params.margin_px(1.0);
        let near_m = params.near_m.unwrap_or(f64::from(self.inputs.settings.atlas.spot_near_m));
        let spot = |(cone, light_from_world)| {
            TileFit::Local(SpotFit::new(cone, light_from_world, near_m, tile_px, margin_px))
        };
        match *shape {
            Shape::Spot { cone, light_from_world } => spot((cone, light_from_world)),
            Shape::Point { position_world, range_m } => spot(point_face(position_world, range_m, tile)),
            Shape::Directional { light_from_world } => {
                let sphere = self.range.sphere(self.range.begin_m, self.range.fit_m);
                let fit = OrthoFit::new(light_from_world, sphere, tile_px, margin_px);
                let fit = fit.with_near_offset(params.near_m.unwrap_or(0.0));
                TileFit::Directional(fit.in_steps_of(params.step_texels))
            }
        }
    }
}

impl TileFit {
    fn view(&self, tile: &TilePlacement, origin_world: glam::DVec3) -> ShadowView {
        match self {
            Self::Local(fit) => ShadowView::spot(fit, tile, origin_world),
            Self::Directional(fit) => ShadowView::directional(fit, tile, origin_world),
        }
    }

    fn cull(&self, planner: &Planner<'_>, params: &LightShadowParams) -> Vec<u32> {
        match self {
            Self::Local(fit) => planner.cull_local(fit, params),
            Self::Directional(fit) => planner.cull_directional(fit, params),
        }
    }
}
