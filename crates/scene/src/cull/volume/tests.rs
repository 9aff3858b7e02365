use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::cull::samples::{boxes, shapes, volume};

fn around(at: DVec3, half: f64) -> Aabb {
    Aabb { min: at - half, max: at + half }
}

fn only_cone(cone: Cone) -> CullVolume {
    CullVolume { cone: Some(cone), ..CullVolume::default() }
}

/// Along +X from the origin, 45 degrees to each side, 10 m.
fn cone() -> Cone {
    Cone { tip_world: DVec3::ZERO, axis: DVec3::X, half_angle: FRAC_PI_2 / 2.0, length_m: 10.0 }
}

/// The distance of a point from a cone without an end, metres.
fn distance_from_cone(cone: &Cone, point: DVec3) -> f64 {
    let from_tip = point - cone.tip_world;
    let along = cone.axis.dot(from_tip);
    let across = (from_tip - cone.axis * along).length();
    let (sin, cos) = cone.half_angle.sin_cos();
    if along * cos + across * sin < 0.0 { from_tip.length() } else { across * cos - along * sin }
}

/// Returns whether the point is inside all shapes by more than the rounding error.
fn contains(volume: &CullVolume, point: DVec3) -> bool {
    let rounding = |size: f64| 1e-14 * (point.abs().max_element() + size.abs());
    let in_sphere = |sphere: &BoundingSphere| {
        let margin = rounding(sphere.center_world.abs().max_element());
        point.distance(sphere.center_world) <= sphere.radius_m - margin
    };
    let in_cone = |cone: &Cone| {
        let margin = rounding(cone.tip_world.abs().max_element());
        let along = cone.axis.dot(point - cone.tip_world);
        distance_from_cone(cone, point) <= -margin && along <= cone.length_m - margin
    };
    let in_plane = |plane: &Plane| plane.signed_distance(point) >= rounding(plane.distance);
    volume.sphere.iter().all(in_sphere)
        && volume.cone.iter().all(in_cone)
        && volume.planes.planes.iter().all(in_plane)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000.max(ProptestConfig::default().cases)))]

    #[test]
    fn a_box_with_a_point_inside_all_shapes_is_never_rejected(
        boxes in boxes(1..4), shapes in shapes(), at in prop::array::uniform3(0.0..=1.0),
    ) {
        let volume = volume(&shapes, &boxes);
        for bounds in boxes.iter().filter(|bounds| !bounds.is_empty()) {
            let edge = DVec3::splat(2e7);
            let [min, max] = [bounds.min, bounds.max].map(|corner| corner.clamp(-edge, edge));
            let point = (min + (max - min) * DVec3::from(at)).clamp(min, max);
            let inside = bounds.contains_point(point) && contains(&volume, point);
            prop_assert!(!inside || volume.intersects(bounds));
        }
    }

    #[test]
    fn planes_alone_decide_as_a_convex_volume_does(boxes in boxes(1..10), (_, _, planes) in shapes()) {
        let volume = volume(&(None, None, planes), &boxes);
        for bounds in boxes.iter().filter(|bounds| bounds.min.abs().max(bounds.max.abs()).max_element() < 1e99) {
            prop_assert_eq!(volume.intersects(bounds), volume.planes.intersects(bounds));
        }
    }

    #[test]
    fn an_empty_box_never_intersects(boxes in boxes(1..10), shapes in shapes()) {
        let volume = volume(&shapes, &boxes);
        prop_assert!(boxes.iter().all(|bounds| !bounds.is_empty() || !volume.intersects(bounds)));
    }

    /// A box's bounding box in the cone's axes extends at most √3 times as far as its bounding sphere.
    #[test]
    fn a_box_a_little_away_from_a_cone_is_rejected(
        direction in prop::array::uniform3(-1.0..=1.0), half_angle in 0.0..=FRAC_PI_2,
        at in prop::array::uniform3(-20.0..=20.0), size in prop::array::uniform3(0.0..=3.0),
    ) {
        let axis = DVec3::from(direction).normalize_or(DVec3::X);
        let cone = Cone { axis, half_angle, length_m: f64::INFINITY, ..cone() };
        let bounds = Aabb { min: at.into(), max: DVec3::from(at) + DVec3::from(size) };
        let away = distance_from_cone(&cone, bounds.center()) > 3f64.sqrt() * bounds.radius() + 1e-9;
        prop_assert!(!away || !only_cone(cone).intersects(&bounds));
    }
}

#[test]
fn boxes_next_to_behind_and_beyond_a_cone_are_rejected() {
    let volume = only_cone(cone());
    for (at, intersects) in [
        (DVec3::X * 5.0, true),
        (DVec3::new(5.0, 5.9, 0.0), true),
        (DVec3::new(5.0, 0.0, -6.1), false),
        (DVec3::X * -0.4, true),
        (DVec3::X * -0.6, false),
        (DVec3::X * 10.4, true),
        (DVec3::X * 10.6, false),
    ] {
        assert_eq!(volume.intersects(&around(at, 0.5)), intersects, "{at}");
    }
    assert!(volume.intersects(&around(DVec3::ZERO, 100.0)));
}

#[test]
fn the_narrowest_cone_is_a_line_and_the_widest_a_half_space() {
    let narrow = only_cone(Cone { half_angle: 0.0, ..cone() });
    assert!(narrow.intersects(&around(DVec3::new(5.0, 0.9, 0.0), 1.0)));
    assert!(!narrow.intersects(&around(DVec3::new(5.0, 1.1, 0.0), 1.0)));
    let wide = only_cone(Cone { half_angle: FRAC_PI_2, ..cone() });
    assert!(wide.intersects(&around(DVec3::new(-0.9, 900.0, 0.0), 1.0)));
    assert!(!wide.intersects(&around(DVec3::new(-1.1, 900.0, 0.0), 1.0)));
}

#[test]
fn a_sphere_rejects_boxes_by_their_nearest_point() {
    let sphere = BoundingSphere { center_world: DVec3::ZERO, radius_m: 5.0 };
    let volume = CullVolume { sphere: Some(sphere), ..CullVolume::default() };
    assert!(volume.intersects(&Aabb { min: DVec3::new(3.0, 4.0, 0.0), max: DVec3::splat(9.0) }));
    assert!(!volume.intersects(&Aabb { min: DVec3::new(3.0, 4.001, 0.0), max: DVec3::splat(9.0) }));
}

#[test]
fn every_shape_can_reject() {
    let sphere = BoundingSphere { center_world: DVec3::X * 5.0, radius_m: 1.0 };
    let planes = ConvexVolume { planes: vec![Plane::through(DVec3::X * 5.0, DVec3::X)] };
    let volume = CullVolume { sphere: Some(sphere), cone: Some(cone()), planes };
    assert!(volume.intersects(&around(DVec3::X * 5.0, 0.1)));
    assert!(!volume.intersects(&around(DVec3::X * 7.0, 0.1)), "the sphere");
    assert!(!volume.intersects(&around(DVec3::X * 4.5, 0.1)), "the plane");
    let aside = Cone { tip_world: DVec3::Y * 20.0, ..cone() };
    assert!(!CullVolume { cone: Some(aside), ..volume }.intersects(&around(DVec3::X * 5.0, 0.1)));
}

#[test]
fn infinite_boxes_intersect_the_volumes_that_they_reach() {
    let floor = Aabb {
        min: DVec3::new(f64::NEG_INFINITY, -1.0, f64::NEG_INFINITY),
        max: DVec3::new(f64::INFINITY, 0.0, f64::INFINITY),
    };
    let above =
        |y: f64| CullVolume::from(ConvexVolume { planes: vec![Plane::through(DVec3::Y * y, DVec3::Y)] });
    assert!(above(-0.5).intersects(&floor));
    assert!(!above(0.5).intersects(&floor));
    assert!(only_cone(cone()).intersects(&floor));
    let all = Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY };
    assert!(CullVolume { cone: Some(cone()), ..above(1e12) }.intersects(&all));
}

/// A sphere, a cone and planes that all contain the surroundings of x = 10.
fn near_ten(planes: usize) -> CullVolume {
    let plane = Plane::through(DVec3::X * 9.0, DVec3::X);
    CullVolume {
        sphere: Some(BoundingSphere { center_world: DVec3::X * 10.0, radius_m: 2.0 }),
        cone: Some(Cone { tip_world: DVec3::ZERO, axis: DVec3::X, half_angle: 0.2, length_m: 11.0 }),
        planes: ConvexVolume { planes: vec![plane; planes] },
    }
}

fn around_x(x: f64, half: f64) -> Aabb {
    Aabb { min: DVec3::X * x - half, max: DVec3::X * x + half }
}

fn classify(planes: usize, bounds: &Aabb) -> Containment {
    PreparedVolume::new(&near_ten(planes)).classify(bounds, ShapeMask::default())
}

#[test]
fn a_box_wholly_inside_all_shapes_is_inside_for_any_number_of_shapes() {
    for planes in [0, 1, 62, 63, 64, 100] {
        assert_eq!(classify(planes, &around_x(10.0, 0.5)), Containment::Inside, "{planes} planes");
        assert_eq!(classify(planes, &around_x(20.0, 0.5)), Containment::Outside, "{planes} planes");
        assert_eq!(classify(planes, &Aabb::EMPTY), Containment::Outside, "{planes} planes");
    }
}

#[test]
fn the_mask_has_exactly_the_shapes_that_contain_the_box() {
    assert_eq!(classify(1, &around_x(9.0, 0.5)), Containment::Partial(ShapeMask(0b011)));
    assert_eq!(classify(1, &around_x(10.8, 0.5)), Containment::Partial(ShapeMask(0b101)));
    assert_eq!(classify(1, &around_x(11.5, 0.5)), Containment::Partial(ShapeMask(0b100)));
    assert_eq!(classify(1, &around_x(10.0, 50.0)), Containment::Partial(ShapeMask(0)));
}

#[test]
fn shapes_of_the_mask_are_not_tested_again() {
    let volume = near_ten(1);
    let prepared = PreparedVolume::new(&volume);
    let far = around_x(1000.0, 1.0);
    assert!(!prepared.intersects(&far, ShapeMask::default()));
    assert!(prepared.intersects(&far, ShapeMask(0b011)), "only the plane is tested");
    assert_eq!(prepared.classify(&far, ShapeMask(0b011)), Containment::Inside);
}

#[test]
fn a_plane_without_a_bit_in_the_mask_is_still_tested() {
    let mut volume = near_ten(63);
    volume.planes.planes[62] = Plane::through(DVec3::X * 10.2, DVec3::X);
    let prepared = PreparedVolume::new(&volume);
    let Containment::Partial(mask) = prepared.classify(&around_x(10.0, 0.5), ShapeMask::default()) else {
        unreachable!("the last plane passes through the box")
    };
    assert!(!prepared.intersects(&around_x(9.8, 0.1), mask));
    assert!(prepared.intersects(&around_x(10.3, 0.1), mask));
}
