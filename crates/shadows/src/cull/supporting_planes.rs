//! Supporting planes of a set of points.

use glam::DVec3;
use shadowgraph_scene::{ConvexVolume, Plane};

/// Outward offset of every plane for rounding, relative to the largest coordinate: some thousand times the rounding error
/// of f64, and still a micrometre at a thousand kilometres.
const ROUNDING: f64 = 1e-12;

/// Distance beyond a plane at which a point still counts as on it, relative to the points' extent.
const TOUCHING: f64 = 1e-9;

/// Normals whose angle is smaller (one minus the cosine; about a millionth of a radian) count as equal.
const SAME: f64 = 1e-12;

/// Collects planes with all points on their inner side.
///
/// The offset of every plane is computed from the points, never from what its normal was derived from: however badly a
/// normal is conditioned, no point is cut off. An inaccurate normal only makes the plane less tight.
pub(crate) struct SupportingPlanes<'a> {
    points: &'a [DVec3],
    out_m: f64,
    touching_m: f64,
    planes: Vec<Plane>,
}

impl<'a> SupportingPlanes<'a> {
    /// Creates an empty collection. The planes will be `pad_m` (metres, at least 0) away from the points.
    pub(crate) fn new(points: &'a [DVec3], pad_m: f64) -> Self {
        let rounding_m = rounding_m(points);
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let touching_m = TOUCHING * (high - low).length() + rounding_m;
        Self { points, out_m: pad_m.max(0.0) + rounding_m, touching_m, planes: Vec::new() }
    }

    /// Adds the supporting plane with this inward normal (unit length), unless it exists already
    /// or a number is not finite.
    pub(crate) fn push(&mut self, normal: DVec3) {
        let nearest = self.points.iter().fold(f64::INFINITY, |least, point| least.min(normal.dot(*point)));
        let distance = self.out_m - nearest;
        let known = self.planes.iter().any(|plane| plane.normal.dot(normal) > 1.0 - SAME);
        if distance.is_finite() && !known {
            self.planes.push(Plane { normal, distance });
        }
    }

    /// Adds the plane through `through` with this normal if all points are on one side, which becomes the inner
    /// side; adds both orientations if all points lie on it.
    pub(crate) fn push_if_outside(&mut self, normal: DVec3, through: DVec3) {
        let heights = self.points.iter().map(|point| normal.dot(*point - through));
        let (low, high) = heights.fold((0.0, 0.0), |(low, high): (f64, f64), h| (low.min(h), high.max(h)));
        if low >= -self.touching_m {
            self.push(normal);
        }
        if high <= self.touching_m {
            self.push(-normal);
        }
    }

    /// Returns the planes in the order in which they were added.
    pub(crate) fn into_planes(self) -> Vec<Plane> {
        self.planes
    }

    /// Returns the volume inside all planes.
    pub(crate) fn into_volume(self) -> ConvexVolume {
        ConvexVolume { planes: self.planes }
    }
}

/// Returns the largest rounding error of results computed from these points, metres; infinite if one is not finite.
pub(crate) fn rounding_m(points: &[DVec3]) -> f64 {
    if !points.iter().all(|point| point.is_finite()) {
        return f64::INFINITY;
    }
    points.iter().fold(0.0, |largest: f64, point| largest.max(point.abs().max_element())) * ROUNDING
}

/// Returns whether two unit vectors are parallel or antiparallel.
pub(crate) fn parallel(a: DVec3, b: DVec3) -> bool {
    a.dot(b).abs() > 1.0 - SAME
}
