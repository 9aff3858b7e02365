//! Cascades: the split of the shadow distance, and the bounding sphere of each slice of the view frustum.

use glam::{DMat3, DVec3};
use shadowgraph_scene::{BoundingSphere, Camera};

use crate::ortho::OrthoFit;
use crate::settings::{CascadeFitting, CascadeSettings, SplitScheme};

/// The slice of the view frustum of one cascade, and its fitted box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CascadeFit {
    /// Start of the slice, metres of view depth.
    pub near_m: f64,
    /// End of the slice, metres of view depth.
    pub far_m: f64,
    /// The box that the tile covers.
    pub fit: OrthoFit,
}

/// A slice of a view frustum between two view depths.
#[derive(Clone, Copy, Debug)]
pub struct Slice<'a> {
    /// The camera of the view.
    pub camera: &'a Camera,
    /// The image's width over its height.
    pub aspect: f64,
    /// Start, metres of view depth.
    pub near_m: f64,
    /// End, metres of view depth, above `near_m`.
    pub far_m: f64,
}

/// Returns the ends of `count` cascades, metres of view depth, ascending; the last is `far_m`.
///
/// `count` is 1 to 8 and `near_m` below `far_m`. Missing ratios are replaced by those of a uniform split.
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
        // The user's ends may be anywhere: every slice gets a minimum length.
        let latest = far_m - (far_m - near_m) * 1e-6 * f64::from(count - 1 - i);
        let end_m = if i + 1 == count { far_m } else { split(scheme, i, count, near_m, far_m) };
        begin_m = end_m.max(begin_m + (far_m - near_m) * 1e-7).min(latest);
        begin_m
    };
    (0..count).map(end).collect()
}

/// Returns the end of cascade `i` of `count`, which is not the last.
fn split(scheme: &SplitScheme, i: u32, count: u32, near_m: f64, far_m: f64) -> f64 {
    let part = f64::from(i + 1) / f64::from(count);
    let length = far_m - near_m;
    let uniform = near_m + length * part;
    let listed = |ends: &[f32]| ends.get(i as usize).map(|end| f64::from(*end));
    let ratio = |ratios: &[f32]| listed(ratios).map_or(uniform, |ratio| near_m + ratio * length);
    // Without a near plane (orthographic cameras) the logarithm needs a first distance above zero.
    let log_near = near_m.max(far_m * 1e-4);
    let logarithmic = log_near * (far_m / log_near).powf(part);
    let to_last = f64::from(count - 1 - i);
    match scheme {
        SplitScheme::Standard => ratio(standard_ratios(count)),
        SplitScheme::Ratios(ratios) => ratio(ratios),
        SplitScheme::Metres(ends) => listed(ends).unwrap_or(uniform),
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

/// Returns the smallest sphere around the slice with its centre on the view's axis.
///
/// The radius comes from the projection alone, so it is the same wherever the camera is and looks.
#[must_use]
pub fn slice_sphere(slice: &Slice<'_>) -> BoundingSphere {
    let Slice { camera, aspect, near_m, far_m } = *slice;
    let corners = camera.slice_corners_view(aspect, near_m, far_m);
    // Squared distance from the axis of the widest corner at each end.
    let lateral = |depth_m: f64, other_m: f64| {
        corners
            .iter()
            .filter(|corner| (-corner.z - depth_m).abs() <= (-corner.z - other_m).abs())
            .fold(0.0, |widest: f64, corner| widest.max(corner.truncate().length_squared()))
    };
    let (at_near, at_far) = (lateral(near_m, far_m), lateral(far_m, near_m));
    // Equidistant from the near and the far corners, unless that is outside the slice.
    let middle = 0.5 * (near_m + far_m) + 0.5 * (at_far - at_near) / (far_m - near_m);
    let center = middle.clamp(near_m, far_m);
    let squared = |lateral: f64, depth: f64| lateral + (depth - center) * (depth - center);
    let radius_m = squared(at_near, near_m).max(squared(at_far, far_m)).sqrt();
    let center_world = camera.world_from_view.transform_point3(DVec3::NEG_Z * center);
    BoundingSphere { center_world, radius_m }
}

/// Fits a box for each cascade. `ends_m` are their far ends in view depth (see [`split_distances`]); the first
/// begins at the camera's near plane, the others overlap the previous one as the settings say. `tile` is the width of a
/// tile in pixels and the margin of [`OrthoFit::new`].
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
