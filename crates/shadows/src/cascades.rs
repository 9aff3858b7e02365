//! Cascades: how the shadow distance is split, and which sphere holds each slice of the view.

use glam::{DMat3, DVec3};
use shadowgraph_scene::Camera;

use crate::{OrthoFit, Sphere, SplitScheme};

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
/// `count` is 1 to 4 and `near_m` below `far_m`. Ratios that are missing are taken from an even split.
///
/// ```
/// use shadowgraph_shadows::{SplitScheme, split_distances};
/// let ends = split_distances(&SplitScheme::Standard, 2, 0.0, 100.0);
/// assert_eq!(ends, [25.0, 100.0]);
/// ```
#[must_use]
pub fn split_distances(scheme: &SplitScheme, count: u32, near_m: f64, far_m: f64) -> Vec<f64> {
    let count = count.max(1);
    let length = far_m - near_m;
    // Without a near plane (orthographic cameras) the logarithm needs some first distance.
    let log_near = near_m.max(far_m * 1e-4);
    let end = |i: u32| {
        let part = f64::from(i + 1) / f64::from(count);
        let ratio = |ratios: &[f32]| near_m + ratios.get(i as usize).map_or(part, |r| f64::from(*r)) * length;
        match scheme {
            SplitScheme::Standard => ratio(standard_ratios(count)),
            SplitScheme::Ratios(ratios) => ratio(ratios),
            SplitScheme::Practical { lambda } => {
                let logarithmic = log_near * (far_m / log_near).powf(part);
                let uniform = near_m + length * part;
                uniform + (logarithmic - uniform) * f64::from(*lambda)
            }
        }
    };
    (0..count).map(|i| if i + 1 == count { far_m } else { end(i) }).collect()
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
pub fn slice_sphere(slice: &Slice<'_>) -> Sphere {
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
    Sphere { center_world, radius_m }
}

/// Fits one box per cascade: `ends_m` are their far ends in view depth (see [`split_distances`]); the first
/// begins at the camera's near plane. `margin_px` is as for [`OrthoFit::new`].
#[must_use]
pub fn fit_cascades(
    camera: &Camera,
    aspect: f64,
    ends_m: &[f64],
    light_from_world: DMat3,
    tile_px: u32,
    margin_px: f64,
) -> Vec<CascadeFit> {
    let mut near_m = camera.near();
    let fit = |&far_m: &f64| {
        let sphere = slice_sphere(&Slice { camera, aspect, near_m, far_m });
        let fit = OrthoFit::new(light_from_world, sphere, tile_px, margin_px);
        let cascade = CascadeFit { near_m, far_m, fit };
        near_m = far_m;
        cascade
    };
    ends_m.iter().map(fit).collect()
}
