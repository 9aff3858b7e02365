//! What a box is tested against: half spaces, spheres and cones, one at a time.
//!
//! A tree may decide for many boxes at once only if it decides as a test of each would, rounding and all. Every
//! test here is made so that it does. It computes from a box's corners with nothing but rounded sums, products,
//! minima and maxima, each of which grows (or falls) with what goes in. So a result for a box bounds the same
//! result for every box within: interval arithmetic keeps inclusions even where it rounds (Moore, "Interval
//! Analysis", 1966).

use crate::{Aabb, Plane};
use glam::DVec3;

use crate::cull::BoundingSphere;

mod cone;
#[cfg(test)]
mod tests;

pub(crate) use cone::ConeFrame;

/// A convex thing that is one part of a volume.
///
/// Where neither of two boxes is empty and `inner` lies within `outer`:
/// - if it touches `inner`, it touches `outer`;
/// - if it holds `outer`, it holds and touches `inner`.
pub(crate) trait Part {
    /// Tells whether the box may touch this. Never false for a box with a point inside.
    fn touches(&self, bounds: &Aabb) -> bool;

    /// Tells whether all of the box lies within this for sure.
    fn holds(&self, bounds: &Aabb) -> bool;
}

/// By the corners that lie furthest to either side, as in Assarsson and Möller, "Optimized View
/// Frustum Culling Algorithms for Bounding Boxes" (2000).
impl Part for Plane {
    fn touches(&self, bounds: &Aabb) -> bool {
        self.signed_distance(furthest_corner(bounds, self.normal)) >= 0.0
    }

    fn holds(&self, bounds: &Aabb) -> bool {
        self.signed_distance(nearest_corner(bounds, self.normal)) >= 0.0
    }
}

/// By the nearest and the farthest point of the box, as in Arvo, "A Simple Method for Box-Sphere Intersection
/// Testing" (Graphics Gems, 1990).
impl Part for BoundingSphere {
    fn touches(&self, bounds: &Aabb) -> bool {
        let nearest = self.center_world.clamp(bounds.min, bounds.max) - self.center_world;
        nearest.length_squared() <= self.radius_m * self.radius_m
    }

    fn holds(&self, bounds: &Aabb) -> bool {
        let farthest = (bounds.min - self.center_world).abs().max((bounds.max - self.center_world).abs());
        farthest.length_squared() <= self.radius_m * self.radius_m
    }
}

/// The corner of the box that lies furthest the way that `axis` points.
fn furthest_corner(bounds: &Aabb, axis: DVec3) -> DVec3 {
    DVec3::select(axis.cmpge(DVec3::ZERO), bounds.max, bounds.min)
}

/// The corner opposite to the furthest.
fn nearest_corner(bounds: &Aabb, axis: DVec3) -> DVec3 {
    DVec3::select(axis.cmpge(DVec3::ZERO), bounds.min, bounds.max)
}
