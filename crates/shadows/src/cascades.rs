//! Cascades: how the shadow distance is split, and which sphere holds each slice of the view.

use glam::{DMat3, DVec3};
use shadowgraph_scene::{BoundingSphere, Camera};

use crate::ortho::OrthoFit;
use crate::settings::{CascadeFitting, CascadeSettings, SplitScheme};

/// The part of the view that one cascade serves, and its place in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeFit {
    /// Where the slice begins, metres of view depth.
    pub near_m: f64,
    /// Where the slice ends, metres of view depth.
    pub far_m: f64,
    /// The box that its tile covers.
    pub fit: OrthoFit,
}

/// A slice of the view: a camera, the picture's width over height, and two view depths in metres.
#[derive(Clone, Copy, Debug)]
pub struct Slice<'a> {
    /// Whose view.
    pub camera: &'a Camera,
    /// The picture's width over its height.
    pub aspect: f64,
    /// Where it begins.
    pub near_m: f64,
    /// Where it ends, above `near_m`.
    pub far_m: f64,
}

/// Returns where each of `count` cascades ends, metres of view depth, rising; the last is `far_m`.
///
/// `count` is 1 to 8 and `near_m` below `far_m`. Ratios that are missing are taken from an even split.
///
/// ```
/// use shadowgraph_shadows::{SplitScheme, split_distances};
/// let ends = split_distances(&SplitScheme::Standard, 2, 0.0, 100.0);
/// assert_eq!(ends, [25.0, 100.0]);
/// let ends = split_distances(&SplitScheme::Factor(3.0), 4, 0.1, 270.0);
/// assert_eq!(ends, [10.0, 30.0, 90.0, 270.0]);
/// ```
#[must_use]
pub fn split_distances(scheme: &SplitScheme, count: u32, near_m: f64, far_m: f64) -> Vec<f64> {
    let count = count.max(1);
    let mut begin_m = near_m;
    let end = |i: u32| {
        // An end of the user's own may be anywhere: every slice has some length.
        let latest = far_m - (far_m - near_m) * 1e-6 * f64::from(count - 1 - i);
        let end_m = if i + 1 == count { far_m } else { split(scheme, i, count, near_m, far_m) };
        begin_m = end_m.max(begin_m + (far_m - near_m) * 1e-7).min(latest);
        begin_m
    };
    (0..count).map(end).collect()
}

/// Where cascade `i` of `count`, which is not the last, ends.
fn split(scheme: &SplitScheme, i: u32, count: u32, near_m: f64, far_m: f64) -> f64 {
    let part = f64::from(i + 1) / f64::from(count);
    let length = far_m - near_m;
    let uniform = near_m + length * part;
    let given = |ends: &[f32]| ends.get(i as usize).map(|end| f64::from(*end));
    let ratio = |ratios: &[f32]| given(ratios).map_or(uniform, |ratio| near_m + ratio * length);
    // Without a near plane (orthographic cameras) the logarithm needs some first distance.
    let log_near = near_m.max(far_m * 1e-4);
    let logarithmic = log_near * (far_m / log_near).powf(part);
    let to_last = f64::from(count - 1 - i);
    match scheme {
        SplitScheme::Standard => ratio(standard_ratios(count)),
        SplitScheme::Ratios(ratios) => ratio(ratios),
        SplitScheme::Metres(ends) => given(ends).unwrap_or(uniform),
        SplitScheme::Factor(factor) => far_m / f64::from(*factor).powf(to_last),
        SplitScheme::Geometric { first_m } => {
            let first = f64::from(*first_m).min(far_m * 0.5f64.powi(count as i32 - 1));
            far_m * (first / far_m).powf(to_last / f64::from(count - 1))
        }
        SplitScheme::Logarithmic => logarithmic,
        SplitScheme::Practical { lambda } => uniform + (logarithmic - uniform) * f64::from(*lambda),
    }
}

fn standard_ratios(count: u32) -> &'static [f32] {
    match count {
        2 => &[0.25],
        3 => &[0.1, 0.35],
        4 => &[0.067, 0.2, 0.467],
        _ => &[],
    }
}

/// Returns the smallest sphere with its centre on the view's axis that holds the slice.
///
/// The radius comes from the projection alone, so it is the same wherever the camera is and looks.
#[must_use]
pub fn slice_sphere(slice: &Slice<'_>) -> BoundingSphere {
    let Slice { camera, aspect, near_m, far_m } = *slice;
    let corners = camera.slice_corners_view(aspect, near_m, far_m);
    // The widest corner at each end, squared distance from the axis.
    let lateral = |depth_m: f64, other_m: f64| {
        corners
            .iter()
            .filter(|corner| (-corner.z - depth_m).abs() <= (-corner.z - other_m).abs())
            .fold(0.0, |widest: f64, corner| widest.max(corner.truncate().length_squared()))
    };
    let (at_near, at_far) = (lateral(near_m, far_m), lateral(far_m, near_m));
    // As far from the near corners as from the far ones, unless that is beyond the slice.
    let middle = 0.5 * (near_m + far_m) + 0.5 * (at_far - at_near) / (far_m - near_m);
    let center = middle.clamp(near_m, far_m);
    let reach = |lateral: f64, depth: f64| lateral + (depth - center) * (depth - center);
    let radius_m = reach(at_near, near_m).max(reach(at_far, far_m)).sqrt();
    let center_world = camera.world_from_view.transform_point3(DVec3::NEG_Z * center);
    BoundingSphere { center_world, radius_m }
}

/// Fits one box per cascade: `ends_m` are their far ends in view depth (see [`split_distances`]); the first
/// begins at the camera's near plane, the others before the end of the last as the settings say. `margin_px` is as for
/// [`OrthoFit::new`].
#[must_use]
pub fn fit_cascades(
    camera: &Camera,
    aspect: f64,
    ends_m: &[f64],
    light_from_world: DMat3,
    tile: (u32, f64),
    settings: &CascadeSettings,
) -> Vec<CascadeFit> {
    let (tile_px, margin_px) = tile;
    let mut last = (camera.near(), camera.near());
    let fit = |&far_m: &f64| {
        let near_m = last.1 - (last.1 - last.0) * settings.slice_overlap();
        last = (last.1, far_m);
        let slice = Slice { camera, aspect, near_m, far_m };
        let fit = match settings.fit {
            CascadeFitting::Stable => {
                OrthoFit::new(light_from_world, slice_sphere(&slice), tile_px, margin_px)
            }
            CascadeFitting::Tight => {
                let corners = camera.slice_corners_view(aspect, near_m, far_m);
                let corners = corners.map(|corner| camera.world_from_view.transform_point3(corner));
                OrthoFit::tight(light_from_world, &corners, tile_px, margin_px)
            }
        };
        let fit = fit.with_near_offset(f64::from(settings.near_offset_m));
        CascadeFit { near_m, far_m, fit }
    };
    ends_m.iter().map(fit).collect()
}
