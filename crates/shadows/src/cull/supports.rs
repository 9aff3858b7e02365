//! Planes that touch a set of points from outside.

use glam::DVec3;
use shadowgraph_scene::{ConvexVolume, Plane};

/// How much of the largest coordinate every plane is moved out for rounding: some thousand times what an f64
/// rounds by, and still a micrometre at a thousand kilometres.
const ROUNDING: f64 = 1e-12;

/// How far beyond a plane, in parts of the points' extent, a point still counts as on it.
const TOUCHING: f64 = 1e-9;

/// Planes whose normals differ by less (one minus the cosine; about a millionth of a radian) count as one.
const SAME: f64 = 1e-12;

/// Collects planes with some points on their inner side.
///
/// Every plane is placed by the points, never by what its normal was derived from: however badly a normal is
/// conditioned, no point is cut off. A bad normal only makes a plane that helps little.
pub(crate) struct Supports<'a> {
    points: &'a [DVec3],
    out_m: f64,
    touching_m: f64,
    planes: Vec<Plane>,
}

impl<'a> Supports<'a> {
    /// Starts without planes. They will be `pad_m` (metres, at least 0) away from the points.
    pub(crate) fn new(points: &'a [DVec3], pad_m: f64) -> Self {
        let rounding_m = rounding_m(points);
        let low = points.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = points.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let touching_m = TOUCHING * (high - low).length() + rounding_m;
        Self { points, out_m: pad_m.max(0.0) + rounding_m, touching_m, planes: Vec::new() }
    }

    /// Adds the plane with this inward normal (unit length) that touches the points, unless there is one already
    /// or a number is not finite.
    pub(crate) fn push(&mut self, normal: DVec3) {
        let nearest = self.points.iter().fold(f64::INFINITY, |least, point| least.min(normal.dot(*point)));
        let distance = self.out_m - nearest;
        let known = self.planes.iter().any(|plane| plane.normal.dot(normal) > 1.0 - SAME);
        if distance.is_finite() && !known {
            self.planes.push(Plane { normal, distance });
        }
    }

    /// Adds the plane through `at` with this normal if it has all points on one side, with that side as the
    /// inner one; both ways round if all points lie on it.
    pub(crate) fn push_if_outside(&mut self, normal: DVec3, at: DVec3) {
        let heights = self.points.iter().map(|point| normal.dot(*point - at));
        let (low, high) = heights.fold((0.0, 0.0), |(low, high): (f64, f64), h| (low.min(h), high.max(h)));
        if low >= -self.touching_m {
            self.push(normal);
        }
        if high <= self.touching_m {
            self.push(-normal);
        }
    }

    /// Returns the planes in the order in which they came.
    pub(crate) fn into_planes(self) -> Vec<Plane> {
        self.planes
    }

    /// Returns the space inside all of the planes.
    pub(crate) fn into_volume(self) -> ConvexVolume {
        ConvexVolume { planes: self.planes }
    }
}

/// Returns how far rounding may move what is computed from these points, metres; infinite where one is not finite.
pub(crate) fn rounding_m(points: &[DVec3]) -> f64 {
    if !points.iter().all(|point| point.is_finite()) {
        return f64::INFINITY;
    }
    points.iter().fold(0.0, |largest: f64, point| largest.max(point.abs().max_element())) * ROUNDING
}

/// Tells whether two unit vectors lie along one line, either way.
pub(crate) fn parallel(a: DVec3, b: DVec3) -> bool {
    a.dot(b).abs() > 1.0 - SAME
}
