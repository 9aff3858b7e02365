//! A test of whether a box in light space may contain something visible.

use glam::{DMat3, DVec2, DVec3};
use shadowgraph_scene::Aabb;

use super::receivers::ReceiverHull;
use super::supporting_planes::{parallel, rounding_m};

/// The visible receivers in light space (x and y across the light, z towards it), prepared for many tests of
/// whether a box intersects them.
///
/// The test uses separating axes (Gottschalk, Lin and Manocha, "OBBTree: A Hierarchical Structure for Rapid
/// Interference Detection", SIGGRAPH 1996), for convex hulls instead of boxes. For a single hull it is exact: every
/// disjoint box is detected.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSpaceView {
    bounds: Aabb,
    sides: Vec<Side>,
    slopes: Vec<Slope>,
}

/// A direction across the light, and the extent of the receivers along it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    normal: DVec2,
    min: f64,
    max: f64,
}

/// Two parallel planes with the receivers between them: `along · xy + z` is between `min` and `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slope {
    along: DVec2,
    min: f64,
    max: f64,
}

/// The sine of the angle between an edge and an axis below which their cross product is not used.
const ALONG_AXIS: f64 = 1e-9;

/// Edges shorter than this, relative to the hull's extent, are skipped: almost points, with inaccurate directions.
const SHORT: f64 = 1e-6;

/// Directions with a smaller z count as lying across the light.
const ACROSS: f64 = 1e-9;

impl LightSpaceView {
    /// Rotates the hull into light space. `light_from_world` is a rotation. A hull that is not finite counts as
    /// the whole space.
    #[must_use]
    pub fn new(view: &ReceiverHull, light_from_world: DMat3) -> Self {
        let view = view.in_light_space(light_from_world);
        if !view.is_finite() {
            let bounds = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
            return Self { bounds, sides: Vec::new(), slopes: Vec::new() };
        }
        let rounding_m = rounding_m(view.corners());
        let Aabb { min, max } = view.bounds();
        let bounds = Aabb { min: min - rounding_m, max: max + rounding_m };
        let mut prepared = Self { bounds, sides: Vec::new(), slopes: Vec::new() };
        for axis in axes(&view) {
            prepared.add(axis, view.corners(), rounding_m);
        }
        prepared
    }

    /// Adds a direction. The hull's extent along it is computed from the corners, so any direction is valid.
    fn add(&mut self, axis: DVec3, corners: &[DVec3], rounding_m: f64) {
        let across = axis.truncate();
        if axis.z.abs() < ACROSS {
            let normal = across.normalize();
            let (min, max) = ends(corners.iter().map(|corner| normal.dot(corner.truncate())));
            self.sides.push(Side { normal, min: min - rounding_m, max: max + rounding_m });
        } else {
            let (along, rounding_m) = (across / axis.z, rounding_m / axis.z.abs());
            let (min, max) = ends(corners.iter().map(|corner| along.dot(corner.truncate()) + corner.z));
            self.slopes.push(Slope { along, min: min - rounding_m, max: max + rounding_m });
        }
    }

    /// Restricts the receivers to those that are in another hull in light space too, such as the bounds of the
    /// scene's receivers, without which the view extends far below the ground.
    ///
    /// Boxes that are small may then be kept although the two hulls do not intersect inside them.
    #[must_use]
    pub fn intersect(mut self, other: &Self) -> Self {
        self.bounds = common(&self.bounds, &other.bounds);
        self.sides.extend_from_slice(&other.sides);
        self.slopes.extend_from_slice(&other.slopes);
        self
    }

    /// Returns the part of a box in which there can be visible receivers; `None` if there are none. Sides of
    /// the box may be at infinity.
    #[must_use]
    pub fn visible_part(&self, bounds: &Aabb) -> Option<Aabb> {
        let mut part = common(bounds, &self.bounds);
        if part.is_empty() {
            return None;
        }
        let center = (part.min.truncate() + part.max.truncate()) * 0.5;
        let half = (part.max.truncate() - part.min.truncate()) * 0.5;
        for &Side { normal, min, max } in &self.sides {
            let (middle, radius) = (normal.dot(center), normal.abs().dot(half));
            if middle + radius < min || middle - radius > max {
                return None;
            }
        }
        for &Slope { along, min, max } in &self.slopes {
            let (middle, radius) = (along.dot(center), along.abs().dot(half));
            part.min.z = part.min.z.max(min - middle - radius);
            part.max.z = part.max.z.min(max - middle + radius);
        }
        (part.min.z <= part.max.z).then_some(part)
    }
}

/// Returns the least and the largest of some numbers.
fn ends(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), n| (min.min(n), max.max(n)))
}

/// Returns the intersection of two boxes. A side of `a` that is not a number is replaced by that of `b`.
fn common(a: &Aabb, b: &Aabb) -> Aabb {
    // DVec3::max returns its argument where the comparison fails.
    Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// Returns the candidate separating axes between the hull and a box, besides the box's own. Cross products of an edge and
/// the light's direction are not needed: among the planes through that edge with a face's slope, or level along
/// x or y, one bounds z from below and one from above, and they cross in such a gap.
fn axes(view: &ReceiverHull) -> Vec<DVec3> {
    let edges = directions(view);
    let orthogonal = |axis: DVec3| {
        let edges = edges.iter();
        edges.map(move |edge| edge.cross(axis)).filter(|across| across.length() > ALONG_AXIS)
    };
    let mut axes = Vec::new();
    let faces = view.faces().iter().map(|face| face.normal);
    let others = orthogonal(DVec3::X).chain(orthogonal(DVec3::Y)).map(DVec3::normalize);
    for axis in faces.chain(others) {
        push_new(&mut axes, axis);
    }
    axes
}

/// Returns the distinct directions of the hull's edges.
fn directions(view: &ReceiverHull) -> Vec<DVec3> {
    let Aabb { min, max } = view.bounds();
    let shortest_m = SHORT * (max - min).length();
    let mut directions = Vec::new();
    for [from, to] in view.edges().filter(|[from, to]| from.distance(*to) > shortest_m) {
        push_new(&mut directions, (to - from).normalize());
    }
    directions
}

fn push_new(known: &mut Vec<DVec3>, direction: DVec3) {
    let is_known = |axis: DVec3| parallel(axis, direction);
    if !known.iter().copied().any(is_known) {
        known.push(direction);
    }
}

#[cfg(test)]
mod tests;
