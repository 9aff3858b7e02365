//! Culling of the casters of each tile.

use glam::DVec3;
use shadowgraph_scene::{Aabb, ConvexVolume, CullVolume, Plane};

use super::Planner;
use crate::cascades::CascadeFit;
use crate::cull::{CoveredByFinerCascade, LightSpaceView, ReceiverHull, RedundantCasters};
use crate::light_params::LightShadowParams;
use crate::ortho::OrthoFit;
use crate::plan::ShadowInputs;
use crate::select::ShadowRange;
use crate::settings::{CascadeSelection, CascadeSettings};
use crate::spot::SpotFit;
use crate::tile_fit::TileFit;

/// The visible receivers.
pub(super) struct VisibleReceivers {
    /// The view up to the shadow distance.
    view: ReceiverHull,
    /// The bounds of all receivers.
    receivers: ReceiverHull,
    /// Largest error of a position on the GPU, metres.
    precision_m: f64,
}

impl VisibleReceivers {
    pub(super) fn new(inputs: &ShadowInputs<'_>, range: &ShadowRange<'_>) -> Self {
        let view = ReceiverHull::from_view(range.camera, range.aspect, range.near_m, range.distance_m);
        let bounds = inputs.casters.receivers();
        let origin = inputs.origin_world;
        let farthest = view.corners().iter().map(|corner| corner.distance(origin)).fold(0.0, f64::max);
        Self { view, receivers: ReceiverHull::from_box(&bounds), precision_m: 1e-4 + 1e-6 * farthest }
    }

    /// Returns the volume in which casters can darken anything visible, with a light in this direction.
    fn towards(&self, to_light: DVec3, pad_m: f64) -> ConvexVolume {
        let pad_m = pad_m + self.precision_m;
        both([&self.view, &self.receivers].map(|hull| hull.swept_towards(to_light, pad_m)))
    }

    /// Returns the same for a light at this position.
    fn around(&self, light_world: DVec3, pad_m: f64) -> ConvexVolume {
        let pad_m = pad_m + self.precision_m;
        both([&self.view, &self.receivers].map(|hull| hull.hull_with(light_world, pad_m)))
    }
}

fn both([mut first, second]: [ConvexVolume; 2]) -> ConvexVolume {
    first.planes.extend(second.planes);
    first
}

impl Planner<'_> {
    /// Returns the casters of a directional light's tile.
    pub(super) fn cull_directional(&self, fit: &OrthoFit, params: &LightShadowParams) -> Vec<u32> {
        self.cull(&self.directional_volume(fit, params))
    }

    /// Returns the volume of the casters of a directional light's tile.
    fn directional_volume(&self, fit: &OrthoFit, params: &LightShadowParams) -> CullVolume {
        let mut planes = fit.cull_volume();
        if self.inputs.settings.cull.unseen {
            planes.planes.extend(self.seen_volume(fit, params).planes);
        }
        planes.into()
    }

    /// Returns the volume in which casters darken what is visible.
    fn seen_volume(&self, fit: &OrthoFit, params: &LightShadowParams) -> ConvexVolume {
        let to_light = fit.light_from_world.transpose().z_axis;
        self.visible.towards(to_light, params.radius_m(fit.texel_m, 1.0))
    }

    /// Returns the volume of the casters of a cascade, without planes that no caster in its box is behind. Where a pass on the GPU fits
    /// the cascade, it is that of all cascades.
    pub(super) fn cascade_volume(&self, fit: &OrthoFit, params: &LightShadowParams) -> CullVolume {
        if self.requirements.fits_on_gpu {
            return self.seen_volume(fit, params).into();
        }
        let mut volume = fit.cull_volume();
        if self.inputs.settings.cull.unseen {
            let corners = fit.caster_corners(&self.inputs.casters.bounds());
            let cuts = |plane: &Plane| corners.iter().any(|&corner| plane.signed_distance(corner) < 0.0);
            volume.planes.extend(self.seen_volume(fit, params).planes.into_iter().filter(cuts));
        }
        volume.into()
    }

    /// Returns the casters of a tile of a spot or point light.
    pub(super) fn cull_local(&self, fit: &SpotFit, params: &LightShadowParams) -> Vec<u32> {
        let mut volume = TileFit::Local(*fit).volume();
        if self.inputs.settings.cull.unseen {
            let pad_m = params.radius_m(fit.texel_per_m() * fit.far_m, 1.0);
            let seen = self.visible.around(fit.cone.position_world, pad_m);
            volume.planes.planes.extend(seen.planes);
        }
        self.cull(&volume)
    }

    /// Returns the casters of each cascade of a light.
    pub(super) fn cull_cascades(&self, fits: &[CascadeFit], params: &LightShadowParams) -> Vec<Vec<u32>> {
        let mut casters: Vec<_> = fits.iter().map(|fit| self.cull_directional(&fit.fit, params)).collect();
        let Some(first) = fits.first() else { return casters };
        if !self.inputs.settings.cull.covered {
            return casters;
        }
        let light_from_world = first.fit.light_from_world;
        let in_light = |hull: &ReceiverHull| LightSpaceView::new(hull, light_from_world);
        let receivers = in_light(&self.visible.receivers);
        let view = in_light(&self.visible.view).intersect(&receivers);
        let covered = self.covered(fits, params, &receivers);
        let axes = glam::DAffine3::from_mat3(light_from_world);
        for (cascade, (fit, casters)) in fits.iter().zip(&mut casters).enumerate().skip(1) {
            let radius_m = params.radius_m(fit.fit.texel_m, largest_scale(&self.inputs.settings.cascades));
            let query =
                RedundantCasters::new(&view, &covered[..cascade], radius_m + self.visible.precision_m);
            let light_bounds = |caster| self.inputs.casters.caster_bounds(caster).transformed(&axes);
            casters.retain(|&caster| !query.is_redundant(&light_bounds(caster)));
        }
        casters
    }

    /// Returns the receivers that read each cascade or a finer one.
    fn covered(
        &self,
        fits: &[CascadeFit],
        params: &LightShadowParams,
        receivers: &LightSpaceView,
    ) -> Vec<CoveredByFinerCascade> {
        let settings = &self.inputs.settings.cascades;
        let blend = f64::from(settings.blend.fraction());
        let scale = f64::from(largest_scale(settings));
        let mut begin_m = self.range.begin_m;
        let covered = |fit: &CascadeFit| {
            let OrthoFit { light_from_world, texel_m, .. } = fit.fit;
            let slack_m =
                self.visible.precision_m + texel_m * (scale * f64::from(params.normal_texels()) + 0.1);
            let length_m = fit.far_m - begin_m;
            begin_m = fit.far_m;
            match settings.select {
                CascadeSelection::Map => {
                    CoveredByFinerCascade::Box(inner_box(&fit.fit, params, slack_m, blend, scale))
                }
                CascadeSelection::Sphere => CoveredByFinerCascade::Sphere {
                    center_light: light_from_world * fit.fit.sphere.center_world,
                    radius_m: fit.fit.sphere.radius_m * (1.0 - blend) - slack_m,
                },
                CascadeSelection::Depth => {
                    let range = &self.range;
                    // Points in front of the first cascade are looked up in the last.
                    let from_m = if range.begins_late() {
                        range.nearest_m
                    } else {
                        fit.far_m - blend * length_m - slack_m
                    };
                    let beyond =
                        ReceiverHull::from_view(range.camera, range.aspect, from_m, range.distance_m);
                    CoveredByFinerCascade::Depth {
                        beyond: LightSpaceView::new(&beyond, light_from_world).intersect(receivers),
                    }
                }
            }
        };
        fits.iter().map(covered).collect()
    }
}

/// Returns the points in light space that a cascade's map covers completely: without its border and its blend, and without
/// the points for which bias or the near plane may select the next cascade.
fn inner_box(fit: &OrthoFit, params: &LightShadowParams, slack_m: f64, blend: f64, scale: f64) -> Aabb {
    let center = fit.center_m();
    let half_texels = 0.5 * f64::from(fit.tile_px) - f64::from(params.border_px());
    let inner = half_texels * (1.0 - blend) * fit.texel_size_m().truncate() - slack_m;
    let steepest = f64::from(params.kernel_radius_texels * params.bias.slope * params.bias.max_slope) * scale;
    let rise_m = std::f64::consts::SQRT_2 * steepest * fit.texel_m;
    let depth_m = fit.depth_range_m();
    let faded_m = 0.5 * blend * depth_m + slack_m + 1e-5 * depth_m;
    let far = fit.far_z_m();
    let across = inner.extend(0.0);
    Aabb {
        min: (center.with_z(far + faded_m)) - across,
        max: (center.with_z(far + depth_m - faded_m - rise_m)) + across,
    }
}

fn largest_scale(settings: &CascadeSettings) -> f32 {
    settings.bias_scales.iter().copied().fold(1.0, f32::max)
}
