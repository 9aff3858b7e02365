use crate::{ConvexVolume, Plane};
use glam::DVec3;

use super::*;
use crate::cull::Cone;

/// A sphere, a cone and planes that all hold what is near x = 10.
fn volume(planes: usize) -> CullVolume {
    let plane = Plane::through(DVec3::X * 9.0, DVec3::X);
    CullVolume {
        sphere: Some(BoundingSphere { center_world: DVec3::X * 10.0, radius_m: 2.0 }),
        cone: Some(Cone { tip_world: DVec3::ZERO, axis: DVec3::X, half_angle: 0.2, length_m: 11.0 }),
        planes: ConvexVolume { planes: vec![plane; planes] },
    }
}

fn around(x: f64, half: f64) -> Aabb {
    Aabb { min: DVec3::X * x - half, max: DVec3::X * x + half }
}

fn place(planes: usize, bounds: &Aabb) -> Place {
    Parts::new(&volume(planes)).place(bounds, Settled::default())
}

#[test]
fn a_box_wholly_inside_all_parts_is_inside_however_many_there_are() {
    for planes in [0, 1, 62, 63, 64, 100] {
        assert_eq!(place(planes, &around(10.0, 0.5)), Place::Inside, "{planes} planes");
        assert_eq!(place(planes, &around(20.0, 0.5)), Place::Outside, "{planes} planes");
        assert_eq!(place(planes, &Aabb::EMPTY), Place::Outside, "{planes} planes");
    }
}

#[test]
fn only_the_parts_that_hold_a_box_are_settled() {
    assert_eq!(place(1, &around(9.0, 0.5)), Place::Across(Settled(0b011)));
    assert_eq!(place(1, &around(10.8, 0.5)), Place::Across(Settled(0b101)));
    assert_eq!(place(1, &around(11.5, 0.5)), Place::Across(Settled(0b100)));
    assert_eq!(place(1, &around(10.0, 50.0)), Place::Across(Settled(0)));
}

#[test]
fn what_is_settled_is_not_tested_again() {
    let volume = volume(1);
    let parts = Parts::new(&volume);
    let far = around(1000.0, 1.0);
    assert!(!parts.touch(&far, Settled::default()));
    assert!(parts.touch(&far, Settled(0b011)), "only the plane is tested");
    assert_eq!(parts.place(&far, Settled(0b011)), Place::Inside);
}

#[test]
fn a_plane_too_many_for_a_bit_is_tested_all_the_same() {
    let mut volume = volume(63);
    volume.planes.planes[62] = Plane::through(DVec3::X * 10.2, DVec3::X);
    let parts = Parts::new(&volume);
    let Place::Across(below) = parts.place(&around(10.0, 0.5), Settled::default()) else {
        unreachable!("the last plane goes through")
    };
    assert!(!parts.touch(&around(9.8, 0.1), below));
    assert!(parts.touch(&around(10.3, 0.1), below));
}
