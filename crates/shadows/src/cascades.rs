//! Cascades: the split of the shadow distance, and the bounding sphere of each slice of the view frustum.

use glam::DVec3;
use shadowgraph_scene::{BoundingSphere, Camera};

use crate::ortho::OrthoFit;
use crate::settings::{CascadeSettings, SplitScheme};

/// The end of a cascade's slice of the view frustum, and the fitted box.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CascadeFit {
    /// End of the slice, metres of view depth.
    pub(crate) far_m: f64,
    /// The box that the tile covers.
    pub(crate) fit: OrthoFit,
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

/// The most slices that are skipped.
const MAX_SKIPPED: usize = 16;

/// Returns where the first cascade begins, metres of view depth, if one slice, two and so on are skipped that would be that of the first cascade.
/// All are between `near_m` and `latest_m`, which is before the end of the last at `far_m`.
pub(crate) fn late_begins(
    settings: &CascadeSettings,
    [near_m, latest_m]: [f64; 2],
    far_m: f64,
) -> impl Iterator<Item = f64> {
    let end_m = move |begin_m: f64| split_distances(&settings.split, settings.count, begin_m, far_m)[0];
    std::iter::successors(Some(end_m(near_m)), move |&begin_m| Some(end_m(begin_m)))
        .take_while(move |&begin_m| begin_m < latest_m)
        .take(MAX_SKIPPED)
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

/// Returns where the slice of each cascade begins and ends, metres of view depth. `ends_m` are their ends (see [`split_distances`]); the
/// first begins at `near_m`, and the others overlap the previous one by a fraction of its length.
pub(crate) fn slices(near_m: f64, ends_m: &[f64], overlap: f64) -> impl Iterator<Item = [f64; 2]> {
    let mut last = [near_m; 2];
    ends_m.iter().map(move |&far_m| {
        let [begin_m, end_m] = last;
        last = [end_m, far_m];
        [end_m - (end_m - begin_m) * overlap, far_m]
    })
}

/// Returns the ends of the cascades after those that cover the same receivers are merged: of all with the same sphere, `whole_m`, the first
/// remains; and a single cascade remains if that gives finer texels than the finest of them. `radii_m` are the radii of the cascades'
/// spheres, `whole_m` that of a single one; `tile_px` returns the width of a tile for a number of cascades.
pub(crate) fn merged(
    ends_m: &[f64],
    radii_m: &[f64],
    whole_m: f64,
    tile_px: impl Fn(usize) -> u32,
) -> Vec<f64> {
    let texel = |radius_m: f64, count: usize| radius_m / f64::from(tile_px(count));
    let finest_m = radii_m.iter().copied().fold(f64::INFINITY, f64::min);
    let count = if texel(whole_m, 1) <= texel(finest_m, ends_m.len()) {
        1
    } else {
        radii_m.iter().take_while(|&&radius_m| radius_m < whole_m).count() + 1
    };
    let (Some(&end_m), true) = (ends_m.last(), count < ends_m.len()) else { return ends_m.to_vec() };
    ends_m[..count - 1].iter().copied().chain([end_m]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the ends of the cascades of one light.
    fn ends(radii_m: [f64; 4], whole_m: f64) -> Vec<f64> {
        merged(&[10.0, 20.0, 40.0, 80.0], &radii_m, whole_m, |count| if count == 1 { 4096 } else { 2048 })
    }

    #[test]
    fn cascades_with_the_same_receivers_are_merged() {
        assert_eq!(ends([8.0, 16.0, 32.0, 64.0], 90.0), [10.0, 20.0, 40.0, 80.0]);
        assert_eq!(ends([8.0, 16.0, 32.0, 40.0], 40.0), [10.0, 20.0, 40.0, 80.0]);
        assert_eq!(ends([8.0, 16.0, 30.0, 30.0], 30.0), [10.0, 20.0, 80.0]);
        assert_eq!(ends([8.0, 17.0, 17.0, 17.0], 17.0), [10.0, 80.0]);
    }

    #[test]
    fn one_cascade_remains_if_its_texels_are_finer() {
        assert_eq!(ends([8.0, 15.0, 15.0, 15.0], 15.0), [80.0]);
        assert_eq!(ends([8.0; 4], 8.0), [80.0]);
        assert_eq!(merged(&[80.0], &[90.0], 90.0, |_| 4096), [80.0]);
    }
}
