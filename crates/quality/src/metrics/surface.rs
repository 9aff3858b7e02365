//! Connectivity of neighbouring pixels.

use super::Samples;

/// Cosine of 10 degrees: a crease is where the normals of neighbours differ by more.
pub const CREASE_COS: f32 = 0.984_807_8;

/// Distance from the other's tangent plane, in pixels, above which there is a silhouette between neighbours.
pub const STEP_PX: f32 = 0.5;

/// Rounding error of stored normals, radians.
const NORMAL_ROUNDING: f32 = 1e-3;

/// Returns whether two nearby pixels are on different surfaces: only one has geometry, or there is a crease or a
/// silhouette between them.
///
/// A silhouette is a step off the tangent plane, not one in depth: a plane seen at a grazing angle has none,
/// however far apart neighbours are. With d from one position to the other and normals a and b, it is where
/// |a·d| or |b·d| is above `STEP_PX` times the side of a pixel at the nearer of the two depths, plus |d| (|a
/// - b| + 0.001): a smooth bend from a to b explains |d| |a - b| / 2.
pub(super) fn is_disconnected(samples: &Samples<'_>, a: usize, b: usize) -> bool {
    if !samples.is_drawn(a) || !samples.is_drawn(b) {
        return samples.is_drawn(a) != samples.is_drawn(b);
    }
    let images = &samples.images;
    let (normal_a, normal_b) = (images.geometric_normals[a], images.geometric_normals[b]);
    if normal_a.dot(normal_b) < CREASE_COS {
        return true;
    }
    let between = images.positions[b] - images.positions[a];
    let footprint_m = images.pixel_m_at_1m * images.view_depths_m[a].min(images.view_depths_m[b]);
    let off_plane_m = normal_a.dot(between).abs().max(normal_b.dot(between).abs());
    let step_m = off_plane_m - STEP_PX * footprint_m;
    // Most neighbours end here, without a root.
    step_m > 0.0 && step_m > between.length() * ((normal_a - normal_b).length() + NORMAL_ROUNDING)
}
