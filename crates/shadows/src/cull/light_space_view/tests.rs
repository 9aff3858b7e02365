#![allow(clippy::print_stdout, reason = "prints measured shares")]

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use shadowgraph_scene::{Aabb, Camera, Projection};

use super::super::random::{Random, View, cases, randoms};
use super::*;

/// Returns a box of some shape around a point, often with the point on its boundary or without extent.
fn box_around(random: &mut Random, point: DVec3, size_m: f64) -> Aabb {
    let mut side = || [0.0, 0.0, 1e-6, 1.0][random.below(4) as usize] * size_m * random.magnitude(-3.0, 0.0);
    let mut sides = || DVec3::new(side(), side(), side());
    Aabb { min: point - sides(), max: point + sides() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn the_visible_part_of_a_box_contains_its_visible_points(mut random in randoms()) {
        let distance_m = random.magnitude(0.0, 6.0);
        let view = random.view(distance_m);
        let to_light = random.light_direction(&view);
        let rotation = random.axes(to_light);
        let prepared = LightSpaceView::new(&view.hull(), rotation);
        let others = Aabb { min: view.point(random.cube()), max: view.point(random.cube()) };
        let others = Aabb { min: others.min.min(others.max), max: others.min.max(others.max) };
        let restricted = prepared.clone().intersect(&LightSpaceView::new(&ReceiverHull::from_box(&others), rotation));
        for _ in 0..20 {
            let world = random.visible(&view);
            let point = rotation * world;
            let mut around = box_around(&mut random, point, view.far_m);
            if random.below(3) == 0 {
                around.min.z = f64::NEG_INFINITY;
            }
            let part = prepared.visible_part(&around);
            prop_assert!(part.is_some_and(|part| part.contains_point(point)), "{around:?}: {part:?}");
            if others.contains_point(world) {
                let part = restricted.visible_part(&around);
                prop_assert!(part.is_some_and(|part| part.contains_point(point)), "restricted: {part:?}");
            }
        }
    }
}

/// Returns whether there is a gap of more than `gap_m` between corners and box. It searches the shortest segment
/// between them (Gilbert's algorithm), which needs no candidate axes; it may miss small gaps.
fn is_disjoint(corners: &[DVec3; 8], from: &Aabb, gap_m: f64) -> bool {
    let box_corners = from.corners();
    let farthest = |points: &[DVec3; 8], direction: DVec3| {
        points.iter().copied().fold(points[0], |a, b| if b.dot(direction) > a.dot(direction) { b } else { a })
    };
    let mut gap = corners[0] - box_corners[0];
    for _ in 0..300 {
        let Some(unit) = gap.try_normalize() else { return false };
        let next = farthest(corners, -gap) - farthest(&box_corners, gap);
        if next.dot(unit) > gap_m {
            return true;
        }
        let along = next - gap;
        let t = -gap.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        gap += along * t.clamp(0.0, 1.0);
    }
    false
}

#[test]
fn every_disjoint_box_is_detected() {
    let mut random = Random(3);
    let (mut detected, mut disjoint, mut all) = (0u32, 0u32, 0u32);
    for _ in 0..2000 {
        let view = random.view(100.0);
        let to_light = random.light_direction(&view);
        let rotation = random.axes(to_light);
        let corners = view.hull().corners().map(|corner| rotation * corner);
        let prepared = LightSpaceView::new(&view.hull(), rotation);
        for _ in 0..10 {
            let nearby = random.visible(&view) + random.unit() * view.far_m * random.magnitude(-3.0, 0.0);
            let size_m = view.far_m * random.magnitude(0.0, 2.0);
            let mut around = box_around(&mut random, rotation * nearby, size_m);
            // Often a column.
            if random.below(2) == 0 {
                let wide_m = view.far_m * random.magnitude(-2.0, 0.0);
                around.min -=
                    DVec3::new(random.fraction() * wide_m, random.fraction() * wide_m, 10.0 * view.far_m);
            }
            all += 1;
            if is_disjoint(&corners, &around, 1e-6 * view.far_m) {
                disjoint += 1;
                detected += u32::from(prepared.visible_part(&around).is_none());
            }
        }
    }
    println!("{detected} of {disjoint} disjoint boxes ({all} in all) are detected");
    assert!(disjoint > all / 4 && detected == disjoint, "{detected} of {disjoint}");
}

#[test]
fn receivers_are_restricted_to_the_bounds() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::Y * 2.0, DVec3::new(0.0, 2.0, -1.0), DVec3::Y, projection);
    let view = View { camera, aspect: 1.5, near_m: 0.1, far_m: 100.0 };
    let scene = Aabb { min: DVec3::new(-200.0, 0.0, -200.0), max: DVec3::new(200.0, 5.0, 200.0) };
    // A light from above: the light's z is the world's y.
    let rotation = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y).transpose();
    let prepared = LightSpaceView::new(&view.hull(), rotation);
    let restricted =
        prepared.clone().intersect(&LightSpaceView::new(&ReceiverHull::from_box(&scene), rotation));
    let below = rotation * DVec3::new(0.0, -4.0, -50.0);
    let column = Aabb { min: (below - 1.0).with_z(f64::NEG_INFINITY), max: below + 1.0 };
    assert!(prepared.visible_part(&column).is_some());
    assert_eq!(restricted.visible_part(&column), None);
    let above = Aabb { max: column.max.with_z(1.0), ..column };
    let part = restricted.visible_part(&above);
    assert!(part.is_some_and(|part| part.min.z.abs() < 1e-9 && part.max.z == 1.0));
}

#[test]
fn a_hull_that_is_not_finite_is_the_whole_space_and_empty_boxes_have_no_visible_part() {
    let prepared = LightSpaceView::new(&ReceiverHull::new([DVec3::NAN; 8]), DMat3::IDENTITY);
    let unit = Aabb { min: DVec3::splat(1e9), max: DVec3::splat(1e9) + 1.0 };
    assert_eq!(prepared.visible_part(&unit), Some(unit));
    assert_eq!(prepared.visible_part(&Aabb::EMPTY), None);
    let finite = LightSpaceView::new(&ReceiverHull::from_box(&unit), DMat3::IDENTITY);
    assert_eq!(prepared.intersect(&finite).visible_part(&Aabb { min: DVec3::ZERO, max: DVec3::ONE }), None);
    assert_eq!(finite.visible_part(&Aabb::EMPTY), None);
    // An invalid box counts as the whole space.
    let invalid = Aabb { min: DVec3::NAN, max: DVec3::NAN };
    assert!(finite.visible_part(&invalid).is_some());
}
