//! Planning of the map of cascades.

use glam::DMat3;

use super::{Planner, placement};
use crate::atlas::{TileLayout, even_tiles};
use crate::cascades::{CascadeFit, fit_cascades, split_distances};
use crate::casters::TileKind;
use crate::light_params::LightShadowParams;
use crate::plan::{MapPlan, TilePlan};
use crate::select::UnshadowedReason;
use crate::select::{Candidate, Shape};
use crate::settings::CascadeSelection;
use crate::tile_fit::TileFit;
use crate::views::{MAP_CASCADES, ShadowView};

/// A light's cascades.
struct Cascades<'s> {
    candidate: Candidate<'s>,
    params: LightShadowParams,
    fits: Vec<CascadeFit>,
    /// The casters of each cascade.
    casters: Vec<Vec<u32>>,
}

impl<'a> Planner<'a> {
    /// Assigns cascades to those of these directional lights that have casters.
    pub(super) fn add_cascades(&mut self, mut lights: Vec<Candidate<'a>>) {
        let settings = &self.inputs.settings.cascades;
        // Lights without casters leave larger tiles for the others.
        let (layout, planned) = loop {
            if lights.is_empty() {
                return;
            }
            let layout = even_tiles(lights.len() * settings.count as usize, settings.map_size_px);
            let (kept, idle): (Vec<_>, Vec<_>) = lights
                .into_iter()
                .map(|light| self.cascades(light, layout.tile_px))
                .partition(|cascades| cascades.casters.iter().any(|casters| !casters.is_empty()));
            for cascades in &idle {
                self.reject(cascades.candidate.light, UnshadowedReason::NoCasterInRange);
            }
            if idle.is_empty() {
                break (layout, kept);
            }
            lights = kept.into_iter().map(|cascades| cascades.candidate).collect();
        };
        let mut map = MapPlan {
            size_px: layout.size_px,
            depth: settings.depth,
            cache: settings.cache && !self.requirements.fits_on_gpu,
            tiles: Vec::new(),
        };
        for (cascades, rects) in planned.into_iter().zip(layout.tiles.chunks(settings.count as usize)) {
            let layout = TileLayout { tiles: rects.to_vec(), ..layout };
            map.tiles.extend(self.add_light(cascades, layout));
        }
        self.plan.cascades = Some(map);
    }

    fn cascades(&self, candidate: Candidate<'a>, tile_px: u32) -> Cascades<'a> {
        let Shape::Directional { light_from_world } = candidate.shape else {
            let params = self.light_params(&candidate, true);
            return Cascades { candidate, params, fits: Vec::new(), casters: Vec::new() };
        };
        let params = self.light_params(&candidate, true);
        let fits = self.fit_cascades(light_from_world, tile_px, &params);
        let mut casters = self.cull_cascades(&fits, &params);
        if self.requirements.fits_on_gpu {
            let mut all = casters.concat();
            all.sort_unstable();
            all.dedup();
            casters.fill(all);
        }
        Cascades { candidate, params, fits, casters }
    }

    fn fit_cascades(
        &self,
        light_from_world: DMat3,
        tile_px: u32,
        params: &LightShadowParams,
    ) -> Vec<CascadeFit> {
        let range = &self.range;
        let settings = &self.inputs.settings.cascades;
        let ends = split_distances(&settings.split, settings.count, range.near_m, range.fit_m);
        let largest_scale = settings.bias_scales.iter().copied().fold(1.0, f32::max);
        let tile = (tile_px, params.margin_px(largest_scale));
        let fit =
            |ends: &[f64]| fit_cascades(range.camera, range.aspect, ends, light_from_world, tile, settings);
        let mut fits = fit(&ends);
        if let Some(last) = fits.last_mut().filter(|_| self.requirements.fits_on_gpu) {
            // The last cascade covers the whole view.
            *last = fit(&[range.fit_m])[0];
        }
        let near_offset_m = params.near_m.unwrap_or(0.0);
        fits.into_iter()
            .map(|cascade| {
                let fit = cascade.fit.with_near_offset(near_offset_m).in_steps_of(params.step_texels);
                CascadeFit { fit, ..cascade }
            })
            .collect()
    }

    /// Adds a light's views, and returns its tiles.
    fn add_light(&mut self, cascades: Cascades<'_>, layout: TileLayout) -> Vec<TilePlan> {
        let Cascades { candidate, params, fits, casters } = cascades;
        let mut settings = self.inputs.settings.cascades.clone();
        if self.requirements.fits_on_gpu {
            settings.select = CascadeSelection::Map;
        }
        let first_view = self.plan.views.len() as u32;
        let mut begin_m = self.range.near_m;
        let mut tiles = Vec::new();
        for (cascade, ((fit, casters), rect)) in (0u32..).zip(fits.iter().zip(casters).zip(layout.tiles)) {
            let tile = placement(rect, layout.size_px, &params, settings.depth.step());
            let (casters, tints) = self.opaque_and_tints(casters);
            self.plan.views.push(ShadowView {
                cascade,
                is_tinted: u32::from(!tints.is_empty()),
                begin_m: begin_m as f32,
                end_m: fit.far_m as f32,
                bias_scale: settings.bias_scales.get(cascade as usize).copied().unwrap_or(1.0),
                ..ShadowView::directional(&fit.fit, &tile, self.inputs.origin_world)
            });
            begin_m = fit.far_m;
            let (light, view, kind) = (candidate.light, first_view + cascade, TileKind::Cascade(cascade));
            let fit = TileFit::Directional(fit.fit);
            tiles.push(TilePlan { light, view, kind, rect, fit, casters, tints });
        }
        if settings.select != CascadeSelection::Map {
            self.plan.views.push(ShadowView::empty());
        }
        let views = (MAP_CASCADES, first_view, tiles.len() as u32);
        let gpu_light = self.set_light(candidate.light, &params, views);
        *gpu_light = gpu_light.with_cascades(&settings);
        tiles
    }
}
