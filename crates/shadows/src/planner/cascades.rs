//! Planning of the map of cascades.

use glam::DMat3;
use shadowgraph_scene::CullVolume;

use super::{Planner, placement};
use crate::atlas::{TileLayout, even_tiles};
use crate::cascades::{CascadeFit, merged, slices, split_distances};
use crate::caster_view::TileKind;
use crate::gpu_casters::GpuCasters;
use crate::light_params::LightShadowParams;
use crate::ortho::OrthoFit;
use crate::plan::{MapPlan, TilePlan};
use crate::select::UnshadowedReason;
use crate::select::{Candidate, Shape};
use crate::settings::{CascadeFitting, CascadeSelection};
use crate::tile_fit::TileFit;
use crate::views::{MAP_CASCADES, ShadowView};

/// A light's cascades.
struct Cascades<'s> {
    candidate: Candidate<'s>,
    params: LightShadowParams,
    fits: Vec<CascadeFit>,
    /// The casters of each cascade.
    casters: Vec<TileCasters>,
}

/// The casters of a tile.
#[derive(Clone, Default)]
pub(super) struct TileCasters {
    pub(super) listed: Vec<u32>,
    pub(super) tints: Vec<u32>,
    pub(super) culled: Option<CullVolume>,
}

impl TileCasters {
    fn is_empty(&self) -> bool {
        self.listed.is_empty() && self.tints.is_empty() && self.culled.is_none()
    }
}

impl<'a> Planner<'a> {
    /// Assigns cascades to those of these directional lights that have casters.
    pub(super) fn add_cascades(&mut self, mut lights: Vec<Candidate<'a>>) {
        let settings = &self.inputs.settings.cascades;
        // Lights without casters leave larger tiles for the others.
        let (layout, count, planned) = loop {
            if lights.is_empty() {
                return;
            }
            let ends_m = self.cascade_ends(lights.len());
            let layout = even_tiles(lights.len() * ends_m.len(), settings.map_size_px);
            let (kept, idle): (Vec<_>, Vec<_>) = lights
                .into_iter()
                .map(|light| self.cascades(light, &ends_m, layout.tile_px))
                .partition(|cascades| !cascades.casters.iter().all(TileCasters::is_empty));
            for cascades in &idle {
                self.reject(cascades.candidate.light, UnshadowedReason::NoCasterInRange);
            }
            if idle.is_empty() {
                break (layout, ends_m.len(), kept);
            }
            lights = kept.into_iter().map(|cascades| cascades.candidate).collect();
        };
        let mut map = MapPlan {
            size_px: layout.size_px,
            depth: settings.depth,
            cache: settings.cache && !self.requirements.fits_on_gpu,
            tiles: Vec::new(),
        };
        for (cascades, rects) in planned.into_iter().zip(layout.tiles.chunks(count)) {
            let layout = TileLayout { tiles: rects.to_vec(), ..layout };
            map.tiles.extend(self.add_light(cascades, layout));
        }
        self.plan.cascades = Some(map);
    }

    /// Returns the ends of the cascades of each of `lights` lights, metres of view depth.
    fn cascade_ends(&self, lights: usize) -> Vec<f64> {
        let range = &self.range;
        let settings = &self.inputs.settings.cascades;
        let ends_m = split_distances(&settings.split, settings.count, range.begin_m, range.fit_m);
        if self.requirements.fits_on_gpu || settings.fit != CascadeFitting::Stable {
            return ends_m;
        }
        let radius = |[near_m, far_m]: [f64; 2]| range.sphere(near_m, far_m).radius_m;
        let slices = slices(range.begin_m, &ends_m, settings.slice_overlap());
        let radii_m: Vec<f64> = slices.map(|slice| radius(range.covered(slice))).collect();
        let tile_px = |count: usize| even_tiles(lights * count, settings.map_size_px).tile_px;
        merged(&ends_m, &radii_m, radius([range.nearest_m, range.fit_m]), tile_px)
    }

    fn cascades(&self, candidate: Candidate<'a>, ends_m: &[f64], tile_px: u32) -> Cascades<'a> {
        let Shape::Directional { light_from_world } = candidate.shape else {
            let params = self.light_params(&candidate, true);
            return Cascades { candidate, params, fits: Vec::new(), casters: Vec::new() };
        };
        let params = self.light_params(&candidate, true);
        let fits = self.fit_cascades(light_from_world, ends_m, tile_px, &params);
        let casters = match self.inputs.casters.gpu() {
            Some(gpu) => self.volumes(gpu, &fits, &params),
            None => self.listed(&fits, &params),
        };
        Cascades { candidate, params, fits, casters }
    }

    /// Lists the casters of each cascade.
    fn listed(&self, fits: &[CascadeFit], params: &LightShadowParams) -> Vec<TileCasters> {
        let mut casters = self.cull_cascades(fits, params);
        if self.requirements.fits_on_gpu {
            let mut all = casters.concat();
            all.sort_unstable();
            all.dedup();
            casters.fill(all);
        }
        let split = |casters| {
            let (listed, tints) = self.opaque_and_tints(casters);
            TileCasters { listed, tints, culled: None }
        };
        casters.into_iter().map(split).collect()
    }

    /// Returns the volumes in which the GPU finds the casters of each cascade.
    fn volumes(
        &self,
        gpu: &dyn GpuCasters,
        fits: &[CascadeFit],
        params: &LightShadowParams,
    ) -> Vec<TileCasters> {
        let in_volume = |fit: &CascadeFit| {
            let volume = self.cascade_volume(&fit.fit, params);
            let mut tints = Vec::new();
            gpu.tinting(&volume, &mut tints);
            TileCasters { listed: Vec::new(), tints, culled: gpu.any(&volume).then_some(volume) }
        };
        fits.iter().map(in_volume).collect()
    }

    /// Fits a box for each cascade.
    fn fit_cascades(
        &self,
        light_from_world: DMat3,
        ends_m: &[f64],
        tile_px: u32,
        params: &LightShadowParams,
    ) -> Vec<CascadeFit> {
        let range = &self.range;
        let settings = &self.inputs.settings.cascades;
        let largest_scale = settings.bias_scales.iter().copied().fold(1.0, f32::max);
        let margin_px = params.margin_px(largest_scale);
        let near_offsets_m = [f64::from(settings.near_offset_m), params.near_m.unwrap_or(0.0)];
        let fit = |[near_m, far_m]: [f64; 2]| {
            let fit = match settings.fit {
                CascadeFitting::Stable => {
                    OrthoFit::new(light_from_world, range.sphere(near_m, far_m), tile_px, margin_px)
                }
                CascadeFitting::Tight => {
                    OrthoFit::tight(light_from_world, &range.corners(near_m, far_m), tile_px, margin_px)
                }
            };
            let fit = near_offsets_m.into_iter().fold(fit, OrthoFit::with_near_offset);
            fit.in_steps_of(params.step_texels)
        };
        let cascade = |slice: [f64; 2]| {
            let [near_m, far_m] = range.covered(slice);
            // Where fits are on the GPU, the last cascade covers the whole view.
            let is_whole = self.requirements.fits_on_gpu && far_m == range.fit_m;
            let begin_m = if is_whole { range.nearest_m } else { near_m };
            CascadeFit { far_m, fit: fit([begin_m, far_m]) }
        };
        slices(range.begin_m, ends_m, settings.slice_overlap()).map(cascade).collect()
    }

    /// Adds a light's views, and returns its tiles.
    fn add_light(&mut self, cascades: Cascades<'_>, layout: TileLayout) -> Vec<TilePlan> {
        let Cascades { candidate, params, fits, casters } = cascades;
        let mut settings = self.inputs.settings.cascades.clone();
        if self.requirements.fits_on_gpu {
            settings.select = CascadeSelection::Map;
        }
        // The others may be fitted again, on the GPU.
        let is_open = fits.last().is_some_and(|last| self.range.is_whole(&last.fit));
        if is_open {
            // Nothing is beyond its edge.
            settings.edge_fade = 0.0;
        }
        let first_view = self.plan.views.len() as u32;
        let mut begin_m = self.range.begin_m;
        let mut tiles = Vec::new();
        for (cascade, ((fit, casters), rect)) in (0u32..).zip(fits.iter().zip(casters).zip(layout.tiles)) {
            let tile = placement(rect, layout.size_px, &params, settings.depth.step());
            let TileCasters { listed, tints, culled } = casters;
            let bias_scale = settings.bias_scales.get(cascade as usize).copied().unwrap_or(1.0);
            self.plan.views.push(ShadowView {
                cascade,
                is_tinted: u32::from(!tints.is_empty()),
                is_open: u32::from(is_open && cascade as usize + 1 == fits.len()),
                begin_m: begin_m as f32,
                end_m: fit.far_m as f32,
                bias_scale,
                ..ShadowView::directional(&fit.fit, &tile, self.inputs.origin_world)
            });
            begin_m = fit.far_m;
            let (light, view, kind) = (candidate.light, first_view + cascade, TileKind::Cascade(cascade));
            let fit = TileFit::Directional(fit.fit);
            let slope_bias_milli = params.slope_bias_milli(bias_scale);
            let casters = listed;
            tiles.push(TilePlan { light, view, kind, rect, fit, slope_bias_milli, casters, culled, tints });
        }
        if settings.select != CascadeSelection::Map {
            self.plan.views.push(ShadowView::empty());
        }
        let views = (MAP_CASCADES, first_view, tiles.len() as u32);
        let gpu_light = self.set_light(candidate.light, &params, views);
        *gpu_light = gpu_light.with_cascades(&settings, &fits, layout.size_px);
        tiles
    }
}
