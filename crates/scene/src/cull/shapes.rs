//! The shapes that a box is tested against: half spaces, spheres and cones.
//!
//! A tree may decide for many boxes at once only if it decides as a test of each box would, rounding included. The
//! tests here allow that. They compute only rounded sums, products, minima and maxima of a box's corners, and each of
//! these grows (or falls) with its operands. So a result for a box bounds the same result for every box inside it:
//! interval arithmetic keeps inclusions even where it rounds (Moore, "Interval Analysis", 1966).

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::bounds::{Aabb, Plane};

#[cfg(test)]
mod tests;

/// A sphere in absolute world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundingSphere {
    /// Its centre, metres.
    pub center_world: DVec3,
    /// Its radius, metres, 0 or above.
    pub radius_m: f64,
}

/// A cone with a flat end in absolute world space.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// The tip, metres.
    pub tip_world: DVec3,
    /// The direction in which it opens, unit length.
    pub axis: DVec3,
    /// Half of the angle at the tip, radians, 0 to π/2.
    pub half_angle: f64,
    /// The distance of the flat end from the tip along the axis, metres; infinite for a cone without an end.
    pub length_m: f64,
}

/// A convex shape, one of those whose intersection is a volume.
///
/// Where neither of two boxes is empty and `inner` lies within `outer`:
/// - a shape that intersects `inner` intersects `outer`;
/// - a shape that contains `outer` contains and intersects `inner`.
pub(crate) trait ConvexShape {
    /// Returns whether the box may intersect the shape. Never false for a box with a point inside.
    fn intersects(&self, bounds: &Aabb) -> bool;

    /// Returns whether the whole box certainly lies within the shape.
    fn contains(&self, bounds: &Aabb) -> bool;
}

/// Tests the box's nearest and farthest corner along the normal (Assarsson and Möller, "Optimized View Frustum Culling
/// Algorithms for Bounding Boxes", 2000).
impl ConvexShape for Plane {
    fn intersects(&self, bounds: &Aabb) -> bool {
        self.signed_distance(farthest_corner(bounds, self.normal)) >= 0.0
    }

    fn contains(&self, bounds: &Aabb) -> bool {
        self.signed_distance(nearest_corner(bounds, self.normal)) >= 0.0
    }
}

/// Tests the nearest and the farthest point of the box (Arvo, "A Simple Method for Box-Sphere Intersection Testing",
/// Graphics Gems, 1990).
impl ConvexShape for BoundingSphere {
    fn intersects(&self, bounds: &Aabb) -> bool {
        let nearest = self.center_world.clamp(bounds.min, bounds.max) - self.center_world;
        nearest.length_squared() <= self.radius_m * self.radius_m
    }

    fn contains(&self, bounds: &Aabb) -> bool {
        let farthest = (bounds.min - self.center_world).abs().max((bounds.max - self.center_world).abs());
        farthest.length_squared() <= self.radius_m * self.radius_m
    }
}

/// A cone prepared for tests of many boxes.
///
/// A box is replaced by the intervals that it spans along the cone's axis and across it, that is by its bounding box in
/// the cone's axes. That box is tested exactly, except at the cone's flat end. It is about as tight as the sphere around
/// the box, needs no square root, and gets smaller for smaller boxes, which spheres do not.
pub(crate) struct PreparedCone {
    tip_world: DVec3,
    axis: DVec3,
    across: [DVec3; 2],
    sin: f64,
    cos: f64,
    length_m: f64,
}

impl PreparedCone {
    /// Not inlined: all callers must share one copy, since a sine may differ from one compilation of it to the next.
    #[inline(never)]
    pub(crate) fn new(cone: &Cone) -> Self {
        let (right, up) = cone.axis.any_orthonormal_pair();
        let (sin, cos) = cone.half_angle.sin_cos();
        Self {
            tip_world: cone.tip_world,
            axis: cone.axis,
            across: [right, up],
            sin,
            cos,
            length_m: cone.length_m,
        }
    }

    /// Returns whether a point at this distance along the axis and this squared distance from it is inside the cone,
    /// ignoring the flat end.
    fn contains_point(&self, along: f64, across_squared: f64) -> bool {
        along >= 0.0 && across_squared * (self.cos * self.cos) <= (along * self.sin) * (along * self.sin)
    }

    fn interval(&self, bounds: &Aabb, axis: DVec3) -> Interval {
        let from_tip = Aabb { min: bounds.min - self.tip_world, max: bounds.max - self.tip_world };
        Interval {
            low: axis.dot(nearest_corner(&from_tip, axis)),
            high: axis.dot(farthest_corner(&from_tip, axis)),
        }
    }
}

impl ConvexShape for PreparedCone {
    fn intersects(&self, bounds: &Aabb) -> bool {
        let along = self.interval(bounds, self.axis);
        let [x, y] = self.across.map(|axis| self.interval(bounds, axis).nearest());
        along.low <= self.length_m && self.contains_point(along.high, x * x + y * y)
    }

    fn contains(&self, bounds: &Aabb) -> bool {
        let along = self.interval(bounds, self.axis);
        let [x, y] = self.across.map(|axis| self.interval(bounds, axis).farthest());
        along.high <= self.length_m && self.contains_point(along.low, x * x + y * y)
    }
}

/// The interval that a box spans along an axis through the tip, metres from the tip.
struct Interval {
    low: f64,
    high: f64,
}

impl Interval {
    /// Returns the least distance from the tip.
    fn nearest(&self) -> f64 {
        self.low.max(-self.high).max(0.0)
    }

    /// Returns the largest distance from the tip.
    fn farthest(&self) -> f64 {
        self.high.max(-self.low)
    }
}

/// Returns the corner of the box that lies farthest in the direction of `axis`.
fn farthest_corner(bounds: &Aabb, axis: DVec3) -> DVec3 {
    DVec3::select(axis.cmpge(DVec3::ZERO), bounds.max, bounds.min)
}

/// Returns the corner opposite to the farthest one.
fn nearest_corner(bounds: &Aabb, axis: DVec3) -> DVec3 {
    DVec3::select(axis.cmpge(DVec3::ZERO), bounds.min, bounds.max)
}
