//! Boxes and volumes for tests, made so that rounding decides: parts of volumes pass through corners of boxes, give
//! or take the last bits, and all of it may lie 10,000 km from the origin.

use crate::{Aabb, ConvexVolume, Plane};
use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;

use crate::cull::{BoundingSphere, Cone, CullVolume};

/// Boxes around one place, of one order of size; some are flat, points, huge, infinite or empty.
pub(crate) fn boxes(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Aabb>> {
    let each = prop::collection::vec((vector(), vector(), 0..40u32), count);
    (place(), scale(), each).prop_map(|(place, scale, each)| {
        let size = |size: DVec3| size.abs() * scale * 0.3;
        each.into_iter().map(|(at, sides, kind)| one_box(place + at * scale, size(sides), kind)).collect()
    })
}

/// A box, and one within it that often shares sides with it or is flat.
pub(crate) fn nested() -> impl Strategy<Value = [Aabb; 2]> {
    let cut = || prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0];
    let cuts = || [cut(), cut(), cut()];
    (place(), scale(), vector(), cuts(), cuts()).prop_map(|(place, scale, size, from, to)| {
        let outer = Aabb::from_points([place, place + size * scale]);
        let at = |cut: [f64; 3]| {
            (outer.min + (outer.max - outer.min) * DVec3::from(cut)).clamp(outer.min, outer.max)
        };
        [outer, Aabb::from_points([at(from), at(to)])]
    })
}

/// What makes a part that passes through a corner of a box.
#[derive(Clone, Debug)]
pub(crate) struct Graze {
    target: (Index, usize),
    /// Where the part is: away from a corner of some other box.
    other: (Index, usize),
    away: DVec3,
    /// Unit length.
    direction: DVec3,
    /// By how many times the last bit the target is missed.
    miss: i32,
    endless: bool,
}

/// What makes a volume: a sphere or none, a cone or none, and planes, sometimes more than have a bit.
pub(crate) type Recipe = (Option<Graze>, Option<Graze>, Vec<Graze>);

pub(crate) fn recipe() -> impl Strategy<Value = Recipe> {
    let few = prop::collection::vec(graze(), 0..4);
    let many = prop::collection::vec(graze(), 60..70);
    (prop::option::of(graze()), prop::option::of(graze()), prop_oneof![9 => few, 1 => many])
}

pub(crate) fn volume((sphere, cone, planes): &Recipe, boxes: &[Aabb]) -> CullVolume {
    let planes = planes.iter().map(|graze| plane(graze, boxes)).collect();
    CullVolume {
        sphere: sphere.as_ref().map(|graze| self::sphere(graze, boxes)),
        cone: cone.as_ref().map(|graze| self::cone(graze, boxes)),
        planes: ConvexVolume { planes },
    }
}

pub(crate) fn graze() -> impl Strategy<Value = Graze> {
    let corner = || (any::<Index>(), 0..8usize);
    let away = prop_oneof![Just(DVec3::ZERO), vector()];
    (corner(), corner(), away, direction(), -2..=2, any::<bool>()).prop_map(
        |(target, other, away, direction, miss, endless)| Graze {
            target,
            other,
            away,
            direction,
            miss,
            endless,
        },
    )
}

pub(crate) fn plane(graze: &Graze, boxes: &[Aabb]) -> Plane {
    let plane = Plane::through(graze.target(boxes), graze.direction);
    Plane { distance: nudged(plane.distance, graze.miss), ..plane }
}

pub(crate) fn sphere(graze: &Graze, boxes: &[Aabb]) -> BoundingSphere {
    let center_world = graze.origin(boxes);
    let radius_m = (graze.target(boxes) - center_world).length();
    BoundingSphere { center_world, radius_m: nudged(radius_m, graze.miss).max(0.0) }
}

pub(crate) fn cone(graze: &Graze, boxes: &[Aabb]) -> Cone {
    let tip_world = graze.origin(boxes);
    let from_tip = graze.target(boxes) - tip_world;
    let along = graze.direction.dot(from_tip);
    let axis = if along < 0.0 { -graze.direction } else { graze.direction };
    let across = (from_tip - graze.direction * along).length();
    let half_angle = nudged(across.atan2(along.abs()), graze.miss).clamp(0.0, std::f64::consts::FRAC_PI_2);
    let length_m = if graze.endless { f64::INFINITY } else { nudged(along.abs(), graze.miss) };
    Cone { tip_world, axis, half_angle, length_m }
}

impl Graze {
    fn target(&self, boxes: &[Aabb]) -> DVec3 {
        corner(&self.target, boxes)
    }

    fn origin(&self, boxes: &[Aabb]) -> DVec3 {
        let other = corner(&self.other, boxes);
        other + self.away * ((self.target(boxes) - other).length() + 1e-7)
    }
}

fn corner((index, corner): &(Index, usize), boxes: &[Aabb]) -> DVec3 {
    let corner = index.get(boxes).corners()[*corner];
    if corner.abs().max_element() < 1e9 { corner } else { DVec3::ZERO }
}

fn one_box(at: DVec3, size: DVec3, kind: u32) -> Aabb {
    let (low, high) = (at, at + size);
    let new = |min: DVec3, max: DVec3| Aabb { min, max };
    match kind {
        0 => Aabb::EMPTY,
        1 => new(high + 1.0, low),
        2 => new(low.with_y(f64::NAN), high),
        3 => new(low, high.with_x(f64::NAN)),
        4 => new(DVec3::NEG_INFINITY, DVec3::INFINITY),
        5 => new(low.with_x(f64::NEG_INFINITY), high),
        6 => new(low, high.with_z(f64::INFINITY)),
        7 => new(DVec3::splat(f64::MIN), DVec3::splat(f64::MAX)),
        8 => new(low.with_y(-1e200), high.with_y(-1e150)),
        9 => new(low.with_y(f64::NEG_INFINITY), high.with_y(f64::NEG_INFINITY)),
        10..15 => new(low, low),
        15..20 => new(low, high.with_y(low.y)),
        20 => new(low - 1e6, high + 1e6),
        _ => new(low, high),
    }
}

fn place() -> impl Strategy<Value = DVec3> {
    prop_oneof![
        Just(DVec3::ZERO),
        vector().prop_map(|at| at * 1e3),
        vector().prop_map(|at| at * 1e7),
        Just(DVec3::new(1e7, 0.0, -1e7)),
    ]
}

fn scale() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1e-7), Just(1.0), Just(300.0)]
}

/// Unit length; often along the world's axes.
fn direction() -> impl Strategy<Value = DVec3> {
    let axes = prop::sample::select(DVec3::AXES.to_vec());
    let signed = (axes, any::<bool>()).prop_map(|(axis, flip)| if flip { -axis } else { axis });
    prop_oneof![1 => signed, 2 => vector().prop_map(|way| way.normalize_or(DVec3::Y))]
}

/// Each coordinate from -1 to 1.
fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..=1.0).prop_map(DVec3::from)
}

fn nudged(value: f64, bits: i32) -> f64 {
    let step = if bits < 0 { f64::next_down } else { f64::next_up };
    (0..bits.abs()).fold(value, |value, _| step(value))
}
