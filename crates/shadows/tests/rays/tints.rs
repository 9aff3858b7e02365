//! Light through translucent surfaces.

use glam::{Vec2, Vec3, Vec4};
use shadowgraph_shadows::rays::{
    Error, Filter, LightShape, RayScene, RayTextureKey, Surface, Tint, Wrap, trace_hard, trace_soft,
};

use crate::common::{Occluder, insert, level_square, on_floor, ray, scene, texture};

/// Returns a horizontal pane around (0, `height`, 0), the texture stretched once over it.
fn pane(height: f32, texture: Option<RayTextureKey>, color: Vec4) -> Vec<Occluder> {
    let uv = |p: Vec3| Vec2::new(p.x + 1.0, p.z + 1.0) / 2.0;
    let tint = |o: Occluder| {
        let tint = Tint { texture, uv: o.corners.map(uv), color: [color; 3], transmits: false };
        Occluder { surface: Surface::Tint(tint), ..o }
    };
    level_square(height, 1.0).into_iter().map(tint).collect()
}

fn transmittance(occluders: &[Occluder]) -> Vec3 {
    scene(occluders).transmittance(&ray(Vec3::new(0.3, 0.0, 0.1), Vec3::new(0.3, 1.0, 0.1)))
}

#[track_caller]
fn assert_near(color: Vec3, expected: [f32; 3]) {
    assert!(color.abs_diff_eq(expected.into(), 0.003), "{color} instead of {expected:?}");
}

#[test]
fn clear_glass_lets_all_light_through_and_opaque_glass_none_for_any_colour() {
    let red = Vec3::new(1.0, 0.0, 0.0);
    assert_eq!(transmittance(&pane(1.0, None, red.extend(0.0))), Vec3::ONE);
    assert_eq!(transmittance(&pane(1.0, None, red.extend(1.0))), Vec3::ZERO);
    assert_eq!(transmittance(&pane(1.0, None, Vec4::ONE)), Vec3::ZERO);
}

#[test]
fn transmitted_light_is_coloured() {
    // Half of the light, times three quarters of the way from white to (1, 0.2, 0).
    assert_near(transmittance(&pane(1.0, None, Vec4::new(1.0, 0.2, 0.0, 0.5))), [0.5, 0.2, 0.125]);
}

#[test]
fn panes_multiply_in_any_order_and_opaque_surfaces_behind_them_block_light() {
    let (red, blue) = (Vec4::new(1.0, 0.2, 0.0, 0.5), Vec4::new(0.0, 0.2, 1.0, 0.5));
    let both = [pane(1.0, None, red), pane(2.0, None, blue)].concat();
    assert_near(transmittance(&both), [0.0625, 0.04, 0.0625]);
    let swapped = [pane(2.0, None, red), pane(1.0, None, blue)].concat();
    assert_eq!(transmittance(&swapped), transmittance(&both));
    assert_eq!(transmittance(&[both, level_square(3.0, 1.0)].concat()), Vec3::ZERO);
}

#[test]
fn texture_and_factor_multiply_and_the_channels_are_alpha_red_green_blue() {
    let channels = [255, 255, 128, 0].map(|value| texture([1, 1], &[value], Wrap::Repeat, Filter::Nearest));
    let mut scene = RayScene::default();
    let color = scene.insert_texture(&channels).unwrap();
    let glass = |texture| pane(1.0, Some(texture), Vec4::new(0.5, 1.0, 1.0, 0.5));
    insert(&mut scene, &glass(color)).unwrap();
    let up = ray(Vec3::new(0.3, 0.0, 0.1), Vec3::new(0.3, 1.0, 0.1));
    assert_near(scene.transmittance(&up), [0.3125, 0.3125, 0.125]);
    let three = scene.insert_texture(&channels[..3]).unwrap();
    assert_eq!(insert(&mut scene, &glass(three)), Err(Error::Channels { needed: 4, count: 3 }));
}

#[test]
fn ground_truth_is_coloured_and_its_nearest_blocker_is_the_nearest_opaque_surface() {
    let glass = [pane(1.0, None, Vec4::new(1.0, 0.0, 0.0, 0.5)), level_square(4.0, 0.5)].concat();
    let scene = scene(&glass);
    let sun = LightShape::Directional { to_light: Vec3::Y, angular_radius: 0.004 };
    let [under_both, under_glass] = [0.2, 0.8].map(|x| on_floor(Vec3::new(x, 0.0, 0.1)));
    for with_blocker in [false, true] {
        assert_near(trace_hard(&scene, &sun, &under_glass, with_blocker).visibility, [0.5, 0.125, 0.125]);
        assert_eq!(trace_hard(&scene, &sun, &under_both, with_blocker).visibility, Vec3::ZERO);
    }
    assert_eq!(trace_hard(&scene, &sun, &under_glass, true).blocker_m, None);
    assert!((trace_hard(&scene, &sun, &under_both, true).blocker_m.unwrap() - 4.0).abs() < 0.01);
    assert_near(trace_soft(&scene, &sun, &under_glass, 8), [0.5, 0.125, 0.125]);
}
