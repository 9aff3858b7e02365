//! The contents of a map do not change as the camera moves: they only shift by whole texels.

use crate::maps::{Map, draw_map};
use crate::stage::{gpu, move_instances};
use glam::{DMat4, DVec3};
use shadowgraph::SceneCasters;
use shadowgraph::scene::gpu::GpuScene;
use shadowgraph::scene::{Camera, origin_near};
use shadowgraph::shadows::{CascadeSettings, Pcf, ShadowSettings, TileRect};
use shadowgraph_samples::demo::demo_scene;

const FRAMES: u32 = 16;
const DEPTH_TOLERANCE: f32 = 1e-5;

/// Returns the movement of a tile between two frames: whole texels in x and y, and a change of depth.
fn shift(before: &Map, after: &Map, view: usize) -> (i32, i32, f32) {
    let of = |map: &Map| map.plan.views[view].map_from_world.as_dmat4();
    let difference: DMat4 = of(after) - of(before);
    for column in 0..3 {
        assert_eq!(difference.col(column).length(), 0.0, "only the translation may change: {difference}");
    }
    let [width, height] = after.size_px.map(f64::from);
    let (x, y) = (difference.w_axis.x * width, difference.w_axis.y * height);
    assert!(x == x.round() && y == y.round(), "the shift is whole texels: {x} {y}");
    (x as i32, y as i32, difference.w_axis.z as f32)
}

/// Compares the overlap of a tile in two frames. Returns the texels, those whose coverage or depth differs, and the largest
/// difference of depth.
fn compare(before: &Map, after: &Map, rect: TileRect, (dx, dy, dz): (i32, i32, f32)) -> (u32, u32, f32) {
    let (mut texels, mut uncovered, mut worst) = (0, 0, 0.0_f32);
    for y in 0..rect.height as i32 {
        for x in 0..rect.width as i32 {
            let (to_x, to_y) = (x + dx, y + dy);
            if to_x < 0 || to_y < 0 || to_x >= rect.width as i32 || to_y >= rect.height as i32 {
                continue;
            }
            let a = before.depth_at(rect.x + x as u32, rect.y + y as u32);
            let b = after.depth_at(rect.x + to_x as u32, rect.y + to_y as u32);
            texels += 1;
            // Depth that is clamped to the near plane or beyond the far plane is not compared.
            let moved = a + dz;
            if (a == 0.0) != (b == 0.0) {
                uncovered += u32::from(moved > DEPTH_TOLERANCE && b.max(a) > dz.abs() + DEPTH_TOLERANCE);
            } else if a > 0.0 && a < 1.0 && b < 1.0 && moved < 1.0 {
                let difference = (moved - b).abs();
                if difference > DEPTH_TOLERANCE {
                    uncovered += 1;
                }
                worst = worst.max(difference.min(DEPTH_TOLERANCE));
            }
        }
    }
    (texels, uncovered, worst)
}

#[test]
fn sub_texel_camera_steps_only_shift_every_cascade_by_whole_texels() {
    let Some(gpu) = gpu() else { return };
    let technique = Pcf::new(&gpu.device);
    for offset in [DVec3::ZERO, DVec3::new(10_000.0, 0.0, 10_000.0)] {
        let mut scene = demo_scene();
        move_instances(&mut scene, offset);
        let mut camera = scene.cameras[0].clone();
        camera.world_from_view.translation += offset;
        let lights = [scene.lights()[0].clone()];
        let cascades = CascadeSettings { map_size_px: 1024, cache: false, ..CascadeSettings::default() };
        let settings = ShadowSettings { distance_m: 60.0, cascades, ..ShadowSettings::default() };
        let origin_world = origin_near(camera.position_world());
        let upload = GpuScene::new(&gpu.device, &gpu.queue, &scene, origin_world).unwrap();
        let casters = SceneCasters::new(&gpu.device, upload).unwrap();
        let map =
            |camera: &Camera| draw_map(gpu, &technique, &casters, &lights, camera, &settings, "cascades");
        let first = map(&camera);
        let texel_m = f64::from(first.plan.views[0].texel_world);
        let (mut texels, mut different, mut moves, mut worst) = (0, 0, 0, 0.0_f32);
        for _ in 1..FRAMES {
            camera.world_from_view.translation += DVec3::new(0.31, 0.07, -0.43) * texel_m;
            let next = map(&camera);
            for (view, tile) in first.plan.cascades.iter().flat_map(|plan| &plan.tiles).enumerate() {
                let shift = shift(&first, &next, view);
                moves += u32::from(shift.0 != 0 || shift.1 != 0);
                let (count, differ, error) = compare(&first, &next, tile.rect, shift);
                texels += count;
                different += differ;
                worst = worst.max(error);
            }
        }
        println!(
            "at {offset}: {moves} shifts, {different} of {texels} texels differ, depth within {worst:e}"
        );
        assert!(moves > 0, "the steps add up to texels");
        assert!(f64::from(different) <= f64::from(texels) * 1e-4, "{different} of {texels} at {offset}");
    }
}
