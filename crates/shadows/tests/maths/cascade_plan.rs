//! The cascades of a plan: their number, what they cover, and their casters.

use glam::DVec3;
use shadowgraph_scene::{Aabb, Camera, Projection, origin_near};
use shadowgraph_shadows::{Requirements, ShadowInputs, ShadowSettings, plan_shadows_after};

use crate::common::{Boxes, Lookup, Receiver, camera, cube, sun};
use crate::plan::{DOWN, cube_in_a_wide_world, default_camera, plan, plan_with, try_plan};

#[test]
fn each_cascade_has_its_own_casters() {
    let near = cube(DVec3::new(0.0, 0.0, 5.0), 1.0);
    let far = cube(DVec3::new(0.0, 0.0, -110.0), 1.0);
    let above = cube(DVec3::new(0.0, 0.0, 5.0) - DOWN * 500.0, 1.0);
    let behind_sun_side = cube(DVec3::new(900.0, 0.0, 0.0), 1.0);
    let plan = plan_with(&[sun(DOWN, 1.0)], vec![near, far, above, behind_sun_side]);
    let tiles = plan.cascades.unwrap().tiles;
    assert_eq!(tiles[0].casters, [0, 2], "casters between light and view are included");
    assert!(tiles[3].casters.contains(&1) && !tiles[1].casters.contains(&1));
    assert!(tiles.iter().all(|tile| !tile.casters.contains(&3)));
}

#[test]
fn one_to_four_cascades_have_their_maps() {
    for (count, size_px) in [(1, [512, 512]), (2, [512, 256]), (3, [512, 512]), (4, [512, 512])] {
        let mut settings = ShadowSettings::default();
        settings.cascades.count = count;
        settings.cascades.map_size_px = 512;
        let casters = Boxes(cube_in_a_wide_world());
        let map =
            try_plan(&default_camera(), &[sun(DOWN, 1.0)], &casters, &settings).unwrap().cascades.unwrap();
        assert_eq!((map.size_px, map.tiles.len()), (size_px, count as usize));
    }
}

#[test]
fn one_cascade_covers_a_small_scene_with_finer_texels() {
    let casters = Boxes(vec![cube(DVec3::ZERO, 2.0)]);
    let settings = ShadowSettings::default();
    let lights = [sun(DOWN, 1.0)];
    let wide = plan(&lights);
    for eye in [DVec3::new(0.0, 2.0, 8.0), DVec3::new(-30.0, 20.0, 6.0)] {
        let small = try_plan(&camera(eye, DVec3::ZERO), &lights, &casters, &settings).unwrap();
        let [tile] = &small.cascades.as_ref().unwrap().tiles[..] else { panic!("one tile") };
        assert_eq!((tile.rect.width, tile.rect.height), (4096, 4096));
        let view = &small.views[tile.view as usize];
        assert!(view.texel_world < 0.5 * wide.views[0].texel_world);
        assert_eq!(view.is_open, 1);
        for corner in cube(DVec3::ZERO, 2.0).corners() {
            let at = view.map_from_world * (corner - origin_near(eye)).as_vec3().extend(1.0);
            assert!(at.truncate().truncate().cmpgt(view.uv_min).all(), "{corner}: {at}");
            assert!(at.truncate().truncate().cmplt(view.uv_max).all(), "{corner}: {at}");
            assert!(at.z > 0.0 && at.z < 1.0, "{corner}: {at}");
        }
    }
}

#[test]
fn points_behind_a_small_scene_are_looked_up_as_no_caster_is_behind_them() {
    let plan = plan_with(&[sun(DOWN, 1.0)], vec![cube(DVec3::ZERO, 2.0)]);
    let view = plan.views.last().unwrap();
    let origin_world = origin_near(default_camera().position_world());
    for metres in [0.0, 3.0, 30.0, 300.0] {
        let position = DOWN.normalize() * metres - origin_world;
        let receiver = Receiver { position, normal: DVec3::Y };
        let lookup = Lookup::new(view, &plan.lights[0], receiver).unwrap();
        assert!(lookup.depth > 0.0 && lookup.depth < 0.6, "{metres} m: {}", lookup.depth);
    }
}

#[test]
fn of_cascades_that_the_gpu_fits_only_the_last_is_open() {
    let requirements = Requirements { fits_on_gpu: true, ..Requirements::NONE };
    let camera = default_camera();
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.5,
        lights: &[sun(DOWN, 1.0)],
        casters: &Boxes(vec![cube(DVec3::ZERO, 0.2)]),
        origin_world: origin_near(camera.position_world()),
        settings: &ShadowSettings::default(),
    };
    let plan = plan_shadows_after(&inputs, None, &requirements).unwrap();
    assert_eq!(plan.views.iter().map(|view| view.is_open).collect::<Vec<_>>(), [0, 0, 0, 1]);
}

#[test]
fn no_cascade_covers_more_than_the_scene() {
    let mut counts = [0; 5];
    let mut last = 0;
    for half_m in [0.5, 2.0, 10.0, 20.0, 40.0, 80.0, 300.0] {
        let casters = vec![cube(DVec3::ZERO, 2.0 * half_m)];
        let plan = plan_with(&[sun(DOWN, 1.0)], casters);
        let tiles = plan.cascades.unwrap().tiles;
        assert!(tiles.len() >= last, "{half_m} m");
        last = tiles.len();
        counts[last] += 1;
        // Texels are finer nearby, and none is wider than a tile around the whole scene needs.
        let radius_m = 3f64.sqrt() * half_m;
        let widest_m = 2.0 * radius_m * 1.1 / (f64::from(tiles[0].rect.width) - 16.0);
        let texels: Vec<_> = plan.views[..last].iter().map(|view| f64::from(view.texel_world)).collect();
        assert!(texels.windows(2).all(|pair| pair[0] < pair[1]), "{half_m} m: {texels:?}");
        assert!(texels.iter().all(|texel| *texel < widest_m), "{half_m} m: {texels:?}, {widest_m}");
        let ends: Vec<_> = plan.views[..last].iter().map(|view| view.end_m).collect();
        assert!(ends.is_sorted(), "{ends:?}");
    }
    assert!(counts[1] > 1 && counts[4] > 1, "{counts:?}");
}

/// Returns the radius of the last cascade of a plan with a cube of this side.
fn last_radius_m(camera: &Camera, side: f64) -> f32 {
    let boxes = Boxes(vec![cube(DVec3::ZERO, side)]);
    let plan = try_plan(camera, &[sun(DOWN, 1.0)], &boxes, &ShadowSettings::default()).unwrap();
    plan.views.last().unwrap().radius
}

#[test]
fn cascades_end_at_the_last_receiver_but_not_beyond_the_shadow_distance() {
    let (small, large, huge) = (
        last_radius_m(&default_camera(), 10.0),
        last_radius_m(&default_camera(), 40.0),
        last_radius_m(&default_camera(), 4000.0),
    );
    assert!(small * 2.0 < large && large * 2.0 < huge, "{small} {large} {huge}");
    assert_eq!(huge, last_radius_m(&default_camera(), 8000.0));
}

#[test]
fn cascades_keep_their_size_when_the_camera_turns() {
    let eye = DVec3::new(3.0, 2.0, 8.0);
    let radii = (0..32).map(|turn| {
        let (sin, cos) = (f64::from(turn) * 0.2).sin_cos();
        last_radius_m(&camera(eye, eye + DVec3::new(cos, -0.3, sin)), 40.0)
    });
    let radii: std::collections::BTreeSet<u32> = radii.map(f32::to_bits).collect();
    assert_eq!(radii.len(), 1, "{radii:?}");
}

#[test]
fn the_end_of_the_cascades_changes_in_steps_and_not_back_at_once() {
    let half_m = 20.0;
    let casters = Boxes(vec![Aabb { min: DVec3::splat(-half_m), max: DVec3::splat(half_m) }]);
    let settings = ShadowSettings { distance_m: 1e5, ..ShadowSettings::default() };
    let mut state = None;
    let mut end_at = |x: f64| {
        let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
        let eye = DVec3::new(x, 0.0, 0.0);
        let camera = Camera::look_at(eye, eye + DVec3::X, DVec3::Y, projection);
        let inputs = ShadowInputs {
            view: 0,
            camera: &camera,
            aspect: 1.0,
            lights: &[sun(DVec3::NEG_Y, 1.0)],
            casters: &casters,
            origin_world: DVec3::ZERO,
            settings: &settings,
        };
        let plan = plan_shadows_after(&inputs, state.as_ref(), &Requirements::NONE).unwrap();
        state = Some(plan.state.clone());
        let farthest = DVec3::new(half_m + x.abs(), half_m, half_m).length();
        assert!(plan.state.receivers.end.distance_m >= farthest, "it contains all receivers");
        plan.state.receivers.end.distance_m
    };
    // A step ends at 2^(21/4) m, 38.05 m: at 5.46 m.
    let ends = [5.0, 5.2, 6.4, 5.3, 6.2, 5.1].map(&mut end_at);
    assert!(ends[0] == ends[1] && ends[1] < ends[2], "{ends:?}");
    assert!(ends[2..].iter().all(|end| *end == ends[2]), "{ends:?}");
    // The end is that of a fresh start a while after it was last needed.
    let rests = [5.1; 120].map(&mut end_at);
    assert_eq!(rests.windows(2).filter(|ends| ends[0] != ends[1]).count(), 1);
    assert_eq!(rests[119], ends[0]);
    // Two steps nearer it follows.
    assert!(end_at(60.0) > ends[2]);
    assert_eq!(end_at(0.0), ends[0]);
}
