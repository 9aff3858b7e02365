//! Whether a box on a light's axes may hold something visible.

use glam::{DMat3, DVec2, DVec3};
use shadowgraph_scene::Aabb;

use super::ReceiverHull;
use super::supports::{parallel, rounding_m};

/// The visible receivers on a light's axes (x and y across the light, z towards it), made ready to be asked many
/// times whether a box touches them.
///
/// The test is that of separating axes (Gottschalk, Lin and Manocha, "OBBTree: A Hierarchical Structure for Rapid
/// Interference Detection", SIGGRAPH 1996), for convex hulls instead of boxes. For one hull it misses nothing: every
/// box apart from it is told to be.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSpaceView {
    bounds: Aabb,
    sides: Vec<Side>,
    slopes: Vec<Slope>,
}

/// A direction across the light, and from where to where the receivers reach along it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Side {
    normal: DVec2,
    min: f64,
    max: f64,
}

/// Two planes with the receivers between them: `along · xy + z` is between `min` and `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slope {
    along: DVec2,
    min: f64,
    max: f64,
}

/// The sine of the angle between an edge and an axis below which no direction is upright on both.
const ALONG_AXIS: f64 = 1e-9;

/// Edges shorter than this part of the hull's extent are left out: all but points, with directions of little worth.
const SHORT: f64 = 1e-6;

/// Directions whose z is less are taken to lie across the light.
const ACROSS: f64 = 1e-9;

impl LightSpaceView {
    /// Rotates the hull onto the light's axes. `light_from_world` is a rotation. A hull that is not finite is
    /// taken to be everywhere.
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

    /// Adds a direction. Where the hull ends along it is found from the corners, so none is ever wrong.
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

    /// Leaves only those receivers that are in another hull too, also on the light's axes: in the bounds of the
    /// scene's receivers, say, without which the view reaches far below the ground.
    ///
    /// Boxes that are not long along the light, or wide, may then be kept although the two hulls meet nowhere
    /// inside them.
    #[must_use]
    pub fn within(mut self, other: &Self) -> Self {
        self.bounds = common(&self.bounds, &other.bounds);
        self.sides.extend_from_slice(&other.sides);
        self.slopes.extend_from_slice(&other.slopes);
        self
    }

    /// Returns the part of the box in which there can be visible receivers; `None` if there are none. Sides of
    /// the box may be infinitely far.
    #[must_use]
    pub fn visible_part(&self, of: &Aabb) -> Option<Aabb> {
        let mut part = common(of, &self.bounds);
        if part.is_empty() {
            return None;
        }
        let center = (part.min.truncate() + part.max.truncate()) * 0.5;
        let half = (part.max.truncate() - part.min.truncate()) * 0.5;
        for &Side { normal, min, max } in &self.sides {
            let (at, reach) = (normal.dot(center), normal.abs().dot(half));
            if at + reach < min || at - reach > max {
                return None;
            }
        }
        for &Slope { along, min, max } in &self.slopes {
            let (at, reach) = (along.dot(center), along.abs().dot(half));
            part.min.z = part.min.z.max(min - at - reach);
            part.max.z = part.max.z.min(max - at + reach);
        }
        (part.min.z <= part.max.z).then_some(part)
    }
}

/// The least and the largest of some numbers.
fn ends(numbers: impl Iterator<Item = f64>) -> (f64, f64) {
    numbers.fold((f64::INFINITY, f64::NEG_INFINITY), |(min, max), at| (min.min(at), max.max(at)))
}

/// The space in both boxes. Where a side of `a` is not a number, that of `b`.
fn common(a: &Aabb, b: &Aabb) -> Aabb {
    // DVec3::max gives its argument where the comparison fails.
    Aabb { min: a.min.max(b.min), max: a.max.min(b.max) }
}

/// The directions, besides the box's own, in which a gap between the hull and a box must show if there is one. Those
/// upright on an edge and the light are not needed: of the planes through that edge with a face's slope, or level along
/// x or y, one bounds z from below and one from above that pass each other in such a gap.
fn axes(view: &ReceiverHull) -> Vec<DVec3> {
    let edges = directions(view);
    let upright = |axis: DVec3| {
        let edges = edges.iter();
        edges.map(move |edge| edge.cross(axis)).filter(|across| across.length() > ALONG_AXIS)
    };
    let mut axes = Vec::new();
    let faces = view.faces().iter().map(|face| face.normal);
    let others = upright(DVec3::X).chain(upright(DVec3::Y)).map(DVec3::normalize);
    for axis in faces.chain(others) {
        push_new(&mut axes, axis);
    }
    axes
}

/// The directions of the hull's edges, each once.
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
    let own = |axis: DVec3| parallel(axis, direction);
    if !known.iter().copied().any(own) {
        known.push(direction);
    }
}

#[cfg(test)]
mod tests;
