//! Boxes and volumes for tests in which rounding decides: the surfaces of volumes pass through corners of boxes within the
//! last bits, and everything may lie 10,000 km from the origin.

use glam::DVec3;
use proptest::prelude::*;
use proptest::sample::Index;

use crate::bounds::{Aabb, ConvexVolume, Plane};
use crate::cull::shapes::{BoundingSphere, Cone};
use crate::cull::volume::CullVolume;

/// Boxes around one point, of similar size; some are flat, points, huge, infinite or empty.
pub(crate) fn boxes(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Aabb>> {
    let each = prop::collection::vec((vector(), vector(), 0..40u32), count);
    (center(), scale(), each).prop_map(|(center, scale, each)| {
        let size = |size: DVec3| size.abs() * scale * 0.3;
        each.into_iter().map(|(at, sides, kind)| one_box(center + at * scale, size(sides), kind)).collect()
    })
}

/// A box, and one within it that often shares sides with it or is flat.
pub(crate) fn nested() -> impl Strategy<Value = [Aabb; 2]> {
    let cut = || prop_oneof![Just(0.0), Just(1.0), 0.0..=1.0];
    let cuts = || [cut(), cut(), cut()];
    (center(), scale(), vector(), cuts(), cuts()).prop_map(|(center, scale, size, from, to)| {
        let outer = Aabb::from_points([center, center + size * scale]);
        let at = |cut: [f64; 3]| {
            (outer.min + (outer.max - outer.min) * DVec3::from(cut)).clamp(outer.min, outer.max)
        };
        [outer, Aabb::from_points([at(from), at(to)])]
    })
}

/// The parameters of a shape whose surface passes through a corner of a box.
#[derive(Clone, Debug)]
pub(crate) struct Tangency {
    target: (Index, usize),
    /// The shape's origin lies at `offset` from a corner of some other box.
    other: (Index, usize),
    offset: DVec3,
    /// Unit length.
    direction: DVec3,
    /// The number of last bits by which the surface misses the corner.
    error_ulps: i32,
    infinite: bool,
}

/// The parameters of a volume: a sphere or none, a cone or none, and planes, sometimes more than a mask has bits for.
pub(crate) type Shapes = (Option<Tangency>, Option<Tangency>, Vec<Tangency>);

pub(crate) fn shapes() -> impl Strategy<Value = Shapes> {
    let few = prop::collection::vec(tangency(), 0..4);
    let many = prop::collection::vec(tangency(), 60..70);
    (prop::option::of(tangency()), prop::option::of(tangency()), prop_oneof![9 => few, 1 => many])
}

pub(crate) fn volume((sphere, cone, planes): &Shapes, boxes: &[Aabb]) -> CullVolume {
    let planes = planes.iter().map(|tangency| plane(tangency, boxes)).collect();
    CullVolume {
        sphere: sphere.as_ref().map(|tangency| self::sphere(tangency, boxes)),
        cone: cone.as_ref().map(|tangency| self::cone(tangency, boxes)),
        planes: ConvexVolume { planes },
    }
}

pub(crate) fn tangency() -> impl Strategy<Value = Tangency> {
    let corner = || (any::<Index>(), 0..8usize);
    let offset = prop_oneof![Just(DVec3::ZERO), vector()];
    (corner(), corner(), offset, direction(), -2..=2, any::<bool>()).prop_map(
        |(target, other, offset, direction, error_ulps, infinite)| Tangency {
            target,
            other,
            offset,
            direction,
            error_ulps,
            infinite,
        },
    )
}

pub(crate) fn plane(tangency: &Tangency, boxes: &[Aabb]) -> Plane {
    let plane = Plane::through(tangency.target(boxes), tangency.direction);
    Plane { distance: nudged(plane.distance, tangency.error_ulps), ..plane }
}

pub(crate) fn sphere(tangency: &Tangency, boxes: &[Aabb]) -> BoundingSphere {
    let center_world = tangency.origin(boxes);
    let radius_m = (tangency.target(boxes) - center_world).length();
    BoundingSphere { center_world, radius_m: nudged(radius_m, tangency.error_ulps).max(0.0) }
}

pub(crate) fn cone(tangency: &Tangency, boxes: &[Aabb]) -> Cone {
    let tip_world = tangency.origin(boxes);
    let from_tip = tangency.target(boxes) - tip_world;
    let along = tangency.direction.dot(from_tip);
    let axis = if along < 0.0 { -tangency.direction } else { tangency.direction };
    let across = (from_tip - tangency.direction * along).length();
    let half_angle =
        nudged(across.atan2(along.abs()), tangency.error_ulps).clamp(0.0, std::f64::consts::FRAC_PI_2);
    let length_m = if tangency.infinite { f64::INFINITY } else { nudged(along.abs(), tangency.error_ulps) };
    Cone { tip_world, axis, half_angle, length_m }
}

impl Tangency {
    fn target(&self, boxes: &[Aabb]) -> DVec3 {
        corner(&self.target, boxes)
    }

    fn origin(&self, boxes: &[Aabb]) -> DVec3 {
        let other = corner(&self.other, boxes);
        other + self.offset * ((self.target(boxes) - other).length() + 1e-7)
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

fn center() -> impl Strategy<Value = DVec3> {
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

/// Unit length; often along the axes of the world.
fn direction() -> impl Strategy<Value = DVec3> {
    let axes = prop::sample::select(DVec3::AXES.to_vec());
    let signed = (axes, any::<bool>()).prop_map(|(axis, flip)| if flip { -axis } else { axis });
    prop_oneof![1 => signed, 2 => vector().prop_map(|vector| vector.normalize_or(DVec3::Y))]
}

/// Each coordinate from -1 to 1.
fn vector() -> impl Strategy<Value = DVec3> {
    prop::array::uniform3(-1.0..=1.0).prop_map(DVec3::from)
}

fn nudged(value: f64, bits: i32) -> f64 {
    let step = if bits < 0 { f64::next_down } else { f64::next_up };
    (0..bits.abs()).fold(value, |value, _| step(value))
}
