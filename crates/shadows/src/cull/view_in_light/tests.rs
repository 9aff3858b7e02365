#![allow(clippy::print_stdout, reason = "shares that are measured")]

use glam::{DMat3, DVec3};
use proptest::prelude::*;
use shadowgraph_scene::{Aabb, Camera, Projection};

use super::super::testing::{CASES, Random, View, randoms};
use super::*;

/// A box of some shape around a point, often with the point on its rim or no extent.
fn box_around(random: &mut Random, point: DVec3, size_m: f64) -> Aabb {
    let mut side = || [0.0, 0.0, 1e-6, 1.0][random.below(4) as usize] * size_m * random.magnitude(-3.0, 0.0);
    let mut sides = || DVec3::new(side(), side(), side());
    Aabb { min: point - sides(), max: point + sides() }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(CASES))]

    #[test]
    fn a_box_with_a_visible_point_keeps_it(mut random in randoms()) {
        let away_m = random.magnitude(0.0, 6.0);
        let view = random.view(away_m);
        let to_light = random.way_to_light(&view);
        let rotation = random.axes(to_light);
        let prepared = LightSpaceView::new(&view.hull(), rotation);
        let others = Aabb { min: view.point(random.cube()), max: view.point(random.cube()) };
        let others = Aabb { min: others.min.min(others.max), max: others.min.max(others.max) };
        let prepared_within = prepared.clone().within(&LightSpaceView::new(&ReceiverHull::of_box(&others), rotation));
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
                let part = prepared_within.visible_part(&around);
                prop_assert!(part.is_some_and(|part| part.contains_point(point)), "within: {part:?}");
            }
        }
    }
}

/// Tells whether there is a gap of more than `gap_m` between corners and box. It looks for the shortest way
/// between them (Gilbert's algorithm), which needs no directions to be known; it may miss small gaps.
fn is_apart(corners: &[DVec3; 8], from: &Aabb, gap_m: f64) -> bool {
    let box_corners = from.corners();
    let farthest = |points: &[DVec3; 8], way: DVec3| {
        points.iter().copied().fold(points[0], |a, b| if b.dot(way) > a.dot(way) { b } else { a })
    };
    let mut way = corners[0] - box_corners[0];
    for _ in 0..300 {
        let Some(unit) = way.try_normalize() else { return false };
        let next = farthest(corners, -way) - farthest(&box_corners, way);
        if next.dot(unit) > gap_m {
            return true;
        }
        let along = next - way;
        let t = -way.dot(along) / along.length_squared().max(f64::MIN_POSITIVE);
        way += along * t.clamp(0.0, 1.0);
    }
    false
}

#[test]
fn every_box_that_is_apart_is_told_to_be() {
    let mut random = Random(3);
    let (mut told, mut apart, mut all) = (0u32, 0u32, 0u32);
    for _ in 0..2000 {
        let view = random.view(100.0);
        let to_light = random.way_to_light(&view);
        let rotation = random.axes(to_light);
        let corners = view.hull().corners().map(|corner| rotation * corner);
        let prepared = LightSpaceView::new(&view.hull(), rotation);
        for _ in 0..10 {
            let beside = random.visible(&view) + random.unit() * view.far_m * random.magnitude(-3.0, 0.0);
            let size_m = view.far_m * random.magnitude(0.0, 2.0);
            let mut around = box_around(&mut random, rotation * beside, size_m);
            // As columns are.
            if random.below(2) == 0 {
                let wide_m = view.far_m * random.magnitude(-2.0, 0.0);
                around.min -= DVec3::new(random.part() * wide_m, random.part() * wide_m, 10.0 * view.far_m);
            }
            all += 1;
            if is_apart(&corners, &around, 1e-6 * view.far_m) {
                apart += 1;
                told += u32::from(prepared.visible_part(&around).is_none());
            }
        }
    }
    println!("{told} of {apart} boxes that are apart ({all} in all) are told to be");
    assert!(apart > all / 4 && told == apart, "{told} of {apart}");
}

#[test]
fn receivers_in_bounds_end_where_the_bounds_do() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::Y * 2.0, DVec3::new(0.0, 2.0, -1.0), DVec3::Y, projection);
    let view = View { camera, aspect: 1.5, near_m: 0.1, far_m: 100.0 };
    let scene = Aabb { min: DVec3::new(-200.0, 0.0, -200.0), max: DVec3::new(200.0, 5.0, 200.0) };
    // A light from above: the light's z is the world's y.
    let rotation = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y).transpose();
    let prepared = LightSpaceView::new(&view.hull(), rotation);
    let within = prepared.clone().within(&LightSpaceView::new(&ReceiverHull::of_box(&scene), rotation));
    let below = rotation * DVec3::new(0.0, -4.0, -50.0);
    let column = Aabb { min: (below - 1.0).with_z(f64::NEG_INFINITY), max: below + 1.0 };
    assert!(prepared.visible_part(&column).is_some());
    assert_eq!(within.visible_part(&column), None);
    let above = Aabb { max: column.max.with_z(1.0), ..column };
    let part = within.visible_part(&above);
    assert!(part.is_some_and(|part| part.min.z.abs() < 1e-9 && part.max.z == 1.0));
}

#[test]
fn a_hull_that_is_not_finite_is_everywhere_and_empty_boxes_are_nowhere() {
    let prepared = LightSpaceView::new(&ReceiverHull::new([DVec3::NAN; 8]), DMat3::IDENTITY);
    let unit = Aabb { min: DVec3::splat(1e9), max: DVec3::splat(1e9) + 1.0 };
    assert_eq!(prepared.visible_part(&unit), Some(unit));
    assert_eq!(prepared.visible_part(&Aabb::EMPTY), None);
    let finite = LightSpaceView::new(&ReceiverHull::of_box(&unit), DMat3::IDENTITY);
    assert_eq!(prepared.within(&finite).visible_part(&Aabb { min: DVec3::ZERO, max: DVec3::ONE }), None);
    assert_eq!(finite.visible_part(&Aabb::EMPTY), None);
    // What is not known is taken to be all.
    let unknown = Aabb { min: DVec3::NAN, max: DVec3::NAN };
    assert!(finite.visible_part(&unknown).is_some());
}
