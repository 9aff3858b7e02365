//! Stable shadows while the camera moves: tiles move in whole texels.

use glam::{DVec2, DVec3};
use shadowgraph_scene::{Camera, Projection, origin_near};
use shadowgraph_shadows::{ShadowInputs, ShadowPlan, ShadowSettings, plan_shadows};

use crate::common::{Boxes, cube, sun};

const ORIGINS: [DVec3; 3] =
    [DVec3::ZERO, DVec3::new(10_000.0, 0.0, 0.0), DVec3::new(-7_071.3, 120.7, 7_071.9)];

fn plan_at(eye: DVec3, forward: DVec3, light: DVec3, origin_world: DVec3) -> ShadowPlan {
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: Some(500.0) };
    let camera = Camera::look_at(eye, eye + forward, DVec3::Y, projection);
    plan_shadows(&ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 16.0 / 9.0,
        lights: &[sun(light, 1.0), sun(light.with_x(0.3), 0.5)],
        casters: &Boxes(vec![cube(eye, 1e4)]),
        origin_world,
        settings: &ShadowSettings::default(),
    })
    .unwrap()
}

/// Returns the movement of each cascade's matrix across the light, texels, with the precision of the GPU. Along the light it
/// stays or moves by a sixteenth of the depth range, less the tile's margin.
fn moved_texels(a: &ShadowPlan, b: &ShadowPlan) -> Vec<DVec2> {
    let cascades = a.views.iter().zip(&b.views).take(4);
    let moved = cascades.map(|(a, b)| {
        let (m, n) = (a.clip_from_world, b.clip_from_world);
        assert_eq!((m.x_axis, m.y_axis, m.z_axis), (n.x_axis, n.y_axis, n.z_axis), "the rest stands still");
        let tile_px = f64::from(a.tile_px[2]);
        let moved = n.w_axis.truncate().as_dvec3() - m.w_axis.truncate().as_dvec3();
        assert!(moved.z == 0.0 || moved.z.abs() > 0.06, "{moved}");
        // x and y go from -1 to 1.
        moved.truncate() * (tile_px / 2.0)
    });
    moved.collect()
}

#[test]
fn sub_texel_steps_move_every_cascade_by_exactly_whole_texels() {
    let forward = DVec3::new(0.3, -0.2, -1.0);
    let light = DVec3::new(-0.4, -0.8, 0.35);
    for base in ORIGINS {
        for step_m in [0.001, 0.0037, 0.013] {
            let origin_world = origin_near(base);
            let step = DVec3::new(0.61, 0.23, -0.76) * step_m;
            let first = plan_at(base, forward, light, origin_world);
            let mut any = [false; 2];
            for frame in 1..=16 {
                let next = plan_at(base + step * f64::from(frame), forward, light, origin_world);
                for moved in moved_texels(&first, &next) {
                    assert_eq!(moved, moved.round(), "at {base}, frame {frame}");
                    let now = moved.to_array().map(|texels| texels != 0.0);
                    any = [0, 1].map(|axis| any[axis] || now[axis]);
                }
            }
            assert!(step_m < 0.01 || any == [true; 2], "nothing moved at {base}: {any:?}");
        }
    }
}

#[test]
fn turning_the_camera_moves_every_cascade_by_exactly_whole_texels() {
    let light = DVec3::new(0.2, -0.9, 0.4);
    for base in ORIGINS {
        let origin_world = origin_near(base);
        let first = plan_at(base, DVec3::NEG_Z, light, origin_world);
        for frame in 1..=16 {
            let angle = f64::from(frame) * 0.0013;
            let next = plan_at(base, DVec3::new(angle.sin(), 0.0, -angle.cos()), light, origin_world);
            for moved in moved_texels(&first, &next) {
                assert_eq!(moved, moved.round(), "at {base}, frame {frame}");
            }
        }
    }
}

#[test]
fn texels_keep_their_world_position_when_the_origin_moves() {
    let forward = DVec3::new(0.3, -0.2, -1.0);
    let light = DVec3::new(-0.4, -0.8, 0.35);
    for base in ORIGINS {
        let origins = [origin_near(base), origin_near(base) + DVec3::new(1024.0, 0.0, -1024.0)];
        let [a, b] = origins.map(|origin_world| plan_at(base, forward, light, origin_world));
        for (a, b) in a.views.iter().zip(&b.views).take(4) {
            let of = |view: &shadowgraph_shadows::ShadowView, origin_world: DVec3| {
                let half_px = f64::from(view.tile_px[2]) / 2.0;
                view.clip_from_world.as_dmat4().transform_point3(base - origin_world) * half_px
            };
            // A sixteenth of a texel, and the rounding of a kilometre in f32.
            let moved = (of(a, origins[0]) - of(b, origins[1])).abs().max_element();
            assert!(moved < 1.0 / 16.0 + 0.02, "{moved} texels at {base}");
        }
    }
}

#[test]
fn further_directional_lights_are_snapped_too() {
    let forward = DVec3::new(0.3, -0.2, -1.0);
    let light = DVec3::new(-0.4, -0.8, 0.35);
    for base in ORIGINS {
        let origin_world = origin_near(base);
        let of = |frame: i32| {
            let step = DVec3::new(0.61, 0.23, -0.76) * 0.05 * f64::from(frame);
            let view = plan_at(base + step, forward, light, origin_world).views[4];
            view.clip_from_world.w_axis.truncate().as_dvec3()
                * DVec3::new(0.5, 0.5, 2.0)
                * f64::from(view.tile_px[2])
        };
        for frame in 1..=16 {
            let moved = of(frame) - of(0);
            assert!((moved - moved.round()).abs().max_element() < 1e-3, "{moved} at {base}");
        }
    }
}
