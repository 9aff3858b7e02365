use glam::Vec3;
use shadowgraph_shadows::rays::{GroundTruth, LightShape, RayScene, trace_hard, trace_soft};

use crate::common::{level_square, on_floor, scene};

const LIT: Vec3 = Vec3::ONE;
const DARK: Vec3 = Vec3::ZERO;

/// Returns a floor, and a 2 m square 3 m above it.
fn table() -> RayScene {
    scene(&[level_square(0.0, 50.0), level_square(3.0, 1.0)].concat())
}

fn sun(to_light: Vec3) -> LightShape {
    LightShape::Directional { to_light: to_light.normalize(), angular_radius: 0.00465 }
}

#[test]
fn the_shadow_of_a_square_has_the_right_extent_and_blocker_distance() {
    let slanted = sun(Vec3::new(1.0, 1.0, 0.0));
    let truth = |x: f32| trace_hard(&table(), &slanted, &on_floor(Vec3::new(x, 0.0, 0.0)), true);
    for (x, visibility) in
        [(-4.01, LIT), (-3.99, DARK), (-3.0, DARK), (-2.01, DARK), (-1.99, LIT), (0.0, LIT)]
    {
        assert_eq!(truth(x).visibility, visibility, "{x}");
    }
    assert!((truth(-3.0).blocker_m.unwrap() - 18f32.sqrt()).abs() < 2e-3);
    assert_eq!(truth(0.0), GroundTruth { visibility: LIT, faces_away: false, blocker_m: None });
    let without_blocker = trace_hard(&table(), &slanted, &on_floor(Vec3::new(-3.0, 0.0, 0.0)), false);
    assert_eq!(without_blocker, GroundTruth { visibility: DARK, faces_away: false, blocker_m: None });
}

#[test]
fn a_surface_that_faces_away_is_dark_without_a_blocker() {
    let empty = scene(&[]);
    for light in [sun(Vec3::new(1.0, -0.1, 0.0)), sun(Vec3::X)] {
        let truth = trace_hard(&empty, &light, &on_floor(Vec3::ZERO), true);
        assert_eq!(truth, GroundTruth { visibility: DARK, faces_away: true, blocker_m: None });
        assert_eq!(trace_soft(&empty, &light, &on_floor(Vec3::ZERO), 16), DARK);
    }
}

#[test]
fn occluders_behind_a_point_light_cast_no_shadow() {
    let light = |y: f32| LightShape::Point { position: Vec3::new(0.0, y, 0.0), radius_m: 0.0 };
    let truth = |y: f32| trace_hard(&table(), &light(y), &on_floor(Vec3::ZERO), true);
    assert_eq!(truth(2.9).visibility, LIT);
    // The light is on the square itself.
    assert_eq!(truth(3.0).visibility, LIT);
    assert_eq!(truth(3.1).visibility, DARK);
    assert!((truth(3.1).blocker_m.unwrap() - 3.0).abs() < 1e-3);
}

#[test]
fn half_of_a_light_hidden_is_half_a_shadow() {
    let half_plane = scene(&crate::common::quad(Vec3::new(0.0, 3.0, -50.0), Vec3::X * 50.0, Vec3::Z * 100.0));
    let wide = LightShape::Directional { to_light: Vec3::Y, angular_radius: 0.1 };
    let point = LightShape::Point { position: Vec3::Y * 6.0, radius_m: 0.5 };
    for light in [wide, point] {
        let at = |x: f32| trace_soft(&half_plane, &light, &on_floor(Vec3::new(x, 0.0, 0.0)), 1024).x;
        assert!((at(0.0) - 0.5).abs() < 0.01, "{}", at(0.0));
        assert_eq!((at(-0.6), at(0.6)), (1.0, 0.0));
        assert!(at(-0.1) > at(0.0) && at(0.0) > at(0.1));
    }
}

#[test]
fn a_quarter_of_the_way_into_a_penumbra_the_known_fraction_of_the_disc_is_visible() {
    let half_plane =
        scene(&crate::common::quad(Vec3::new(0.0, 10.0, -50.0), Vec3::X * 50.0, Vec3::Z * 100.0));
    let light = LightShape::Directional { to_light: Vec3::Y, angular_radius: 0.1f32.atan() };
    let seen = trace_soft(&half_plane, &light, &on_floor(Vec3::new(0.5, 0.0, 0.0)), 4096).x;
    // A chord at half the radius cuts off 1/3 - sqrt(3)/(4 pi) of a disc.
    let cut_off = 1.0 / 3.0 - 3f32.sqrt() / (4.0 * std::f32::consts::PI);
    assert!((seen - cut_off).abs() < 0.005, "{seen} {cut_off}");
}

#[test]
fn soft_rays_are_deterministic_and_one_ray_is_allowed() {
    let light = LightShape::Point { position: Vec3::Y * 6.0, radius_m: 2.0 };
    let at = |rays| trace_soft(&table(), &light, &on_floor(Vec3::new(1.5, 0.0, 0.2)), rays).x;
    assert_eq!(at(64), at(64));
    assert!(at(64) > 0.0 && at(64) < 1.0);
    assert_eq!(at(0), at(1));
}
