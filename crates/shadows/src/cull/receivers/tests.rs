use proptest::prelude::*;
use shadowgraph_scene::Projection;

use super::super::random::{cases, randoms};
use super::*;

fn box_of(size: DVec3) -> ReceiverHull {
    ReceiverHull::from_box(&Aabb { min: -size, max: size })
}

#[test]
fn a_box_has_six_faces_twelve_edges_and_the_same_bounds() {
    let hull = box_of(DVec3::new(1.0, 2.0, 3.0));
    assert_eq!((hull.faces().len(), hull.edges().count()), (6, 12));
    for [from, to] in hull.edges() {
        assert_eq!((to - from).abs().to_array().iter().filter(|&&side| side > 0.0).count(), 1);
    }
    for axis in DVec3::AXES {
        assert!(hull.faces().iter().any(|face| face.normal.abs_diff_eq(axis, 1e-12)));
        assert!(hull.faces().iter().any(|face| face.normal.abs_diff_eq(-axis, 1e-12)));
    }
    assert_eq!(hull.bounds().max, DVec3::new(1.0, 2.0, 3.0));
}

#[test]
fn a_flat_hull_has_both_orientations_of_its_plane_and_a_line_has_no_plane() {
    let flat = box_of(DVec3::new(1.0, 0.0, 3.0));
    let normals: Vec<DVec3> = flat.faces().iter().map(|face| face.normal).collect();
    assert_eq!(normals.len(), 2);
    assert!(normals[0].abs_diff_eq(-normals[1], 1e-12) && normals[0].y.abs() > 0.999);
    assert!(box_of(DVec3::X).faces().is_empty());
    assert!(box_of(DVec3::ZERO).faces().is_empty());
}

#[test]
fn a_hull_that_is_not_finite_has_no_faces() {
    let hull = box_of(DVec3::new(1.0, f64::NAN, 1.0));
    assert!(!hull.is_finite() && hull.faces().is_empty());
    assert!(box_of(DVec3::splat(f64::INFINITY)).faces().is_empty());
}

#[test]
fn a_view_to_infinity_has_no_faces() {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::Y, projection);
    assert!(ReceiverHull::from_view(&camera, 1.0, 0.1, f64::INFINITY).faces().is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn faces_bound_the_view_tightly(mut random in randoms()) {
        let distance_m = random.magnitude(0.0, 6.0);
        let view = random.view(distance_m);
        let hull = view.hull();
        // A tiny near plane may count as a line or add one plane.
        prop_assert!((5..=7).contains(&hull.faces().len()), "{}", hull.faces().len());
        let point = random.visible(&view);
        for face in hull.faces() {
            prop_assert!(face.signed_distance(point) >= 0.0);
        }
        let nearby = point + random.unit() * view.far_m * random.magnitude(-3.0, 1.0);
        let slack_m = 1e-7 * (view.far_m + distance_m);
        if hull.faces().iter().all(|face| face.signed_distance(nearby) >= 0.0) {
            prop_assert!(view.distance(nearby) <= slack_m, "{} m outside", view.distance(nearby));
        }
    }

    #[test]
    fn in_light_space_it_is_the_same_hull(mut random in randoms()) {
        let view = random.view(1000.0);
        let to_light = random.light_direction(&view);
        let rotation = random.axes(to_light);
        let point = random.visible(&view);
        let hull = view.hull().in_light_space(rotation);
        for face in hull.faces() {
            prop_assert!(face.signed_distance(rotation * point) >= -1e-9 * (1000.0 + view.far_m));
        }
        prop_assert!(hull.corners()[5].abs_diff_eq(rotation * view.hull().corners()[5], 1e-6));
    }
}
