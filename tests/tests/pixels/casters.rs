//! Tests which geometry casts a shadow.

use crate::maps::draw_map;
use crate::stage::{
    SIZE_PX, add_cube, add_instance, add_mesh, camera, cube_on_floor, draw, floor_mesh, gpu, material,
    nth_instance, sun, vertex, view,
};
use glam::DVec3;
use shadowgraph::SceneCasters;
use shadowgraph::options::Aov;
use shadowgraph::scene::gpu::{DepthTarget, GpuScene};
use shadowgraph::scene::{AlphaMode, Image, Mesh, Scene, TextureRef};
use shadowgraph::shadows::{Pcf, ShadowSettings};

/// Returns a floor under a vertical sun, and above it a square of 2 m whose left half is transparent in its texture.
fn half_cut_sheet(alpha: AlphaMode) -> Scene {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let mut vertices = corners.map(|(x, z)| vertex(DVec3::new(x, 0.0, z), [0.0, 1.0, 0.0]));
    for (vertex, (x, z)) in vertices.iter_mut().zip(corners) {
        vertex.uv0 = [x as f32 * 0.5 + 0.5, z as f32 * 0.5 + 0.5];
    }
    let sheet = Mesh::new("sheet", vertices.to_vec(), vec![0, 1, 2, 0, 2, 3]);
    let rgba8 = (0..64).flat_map(|i| [255, 255, 255, if i % 8 < 4 { 0 } else { 255 }]).collect();
    let image = Image::new("half", 8, 8, rgba8);
    let mut scene = Scene::default();
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(20.0), DVec3::ZERO);
    let base_color_texture = Some(TextureRef::new(scene.insert_image(image).unwrap()));
    let sheet_material = shadowgraph::scene::Material { alpha, base_color_texture, ..material() };
    let (sheet, sheet_material) = (scene.insert_mesh(sheet), scene.insert_material(sheet_material).unwrap());
    add_instance(&mut scene, sheet, sheet_material, DVec3::new(0.0, 1.5, 0.0));
    scene.insert_light(sun(DVec3::NEG_Y));
    scene
}

/// Returns the visibility of a floor point below the sheet, seen from the side.
fn visibility(scene: Scene, at: DVec3) -> Option<u8> {
    let gpu = gpu()?;
    let options = view(camera(DVec3::new(0.0, 0.7, 4.0), DVec3::new(0.0, 0.3, 0.0)), 20.0);
    let image = draw(gpu, scene, Aov::Visibility(0), &options).image;
    let clip = options.camera.clip_from_view(f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]))
        * options.camera.view_from_world();
    let ndc = clip.project_point3(at);
    let x = ((ndc.x * 0.5 + 0.5) * f64::from(SIZE_PX[0])) as u32;
    let y = ((0.5 - ndc.y * 0.5) * f64::from(SIZE_PX[1])) as u32;
    let [grey, _, _, alpha] = image.pixel(x, y).unwrap();
    assert_eq!(alpha, 255, "the floor is visible at {x} {y}");
    Some(grey)
}

#[test]
fn an_alpha_masked_sheet_casts_the_shadow_of_its_opaque_part() {
    let (hole, rest) = (DVec3::new(-0.6, 0.0, 0.3), DVec3::new(0.6, 0.0, 0.3));
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    let Some(through) = visibility(half_cut_sheet(mask), hole) else { return };
    assert_eq!(through, 255, "light falls through the hole");
    assert_eq!(visibility(half_cut_sheet(mask), rest), Some(0));
    assert_eq!(
        visibility(half_cut_sheet(AlphaMode::Opaque), hole),
        Some(0),
        "but not through an opaque sheet"
    );
}

#[test]
fn a_blended_sheet_casts_the_shadow_of_its_opaque_part() {
    let Some(through) = visibility(half_cut_sheet(AlphaMode::Blend), DVec3::new(-0.6, 0.0, 0.3)) else {
        return;
    };
    assert_eq!(through, 255);
    assert_eq!(visibility(half_cut_sheet(AlphaMode::Blend), DVec3::new(0.6, 0.0, 0.3)), Some(0));
}

#[test]
fn a_single_sided_wall_casts_shadows_on_both_sides() {
    let mut scene = half_cut_sheet(AlphaMode::Opaque);
    // Upside down: the sun sees only back faces.
    let turned = glam::DMat3::from_rotation_x(std::f64::consts::PI);
    scene.edit_instance(nth_instance(&scene, 1), |sheet| sheet.world_from_local.matrix3 = turned).unwrap();
    let Some(grey) = visibility(scene, DVec3::new(0.6, 0.0, 0.3)) else { return };
    assert_eq!(grey, 0);
}

#[test]
fn a_caster_far_above_the_view_keeps_its_shadow() {
    let mut scene = half_cut_sheet(AlphaMode::Opaque);
    // Far above the sphere that the cascades are fitted to: clamped to the near plane.
    scene
        .edit_instance(nth_instance(&scene, 1), |sheet| sheet.world_from_local.translation.y = 500.0)
        .unwrap();
    let Some(grey) = visibility(scene, DVec3::new(0.6, 0.0, 0.3)) else { return };
    assert_eq!(grey, 0);
}

#[test]
fn depth_clamp_in_the_fragment_shader_gives_the_map_of_the_hardware_clamp() {
    let Some(gpu) = gpu() else { return };
    let clips = shadowgraph::wgpu::Features::DEPTH_CLIP_CONTROL;
    if !gpu.device.features().contains(clips) {
        return shadowgraph_tests::skip(
            "depth_clip_control",
            "the adapter has no DEPTH_CLIP_CONTROL to compare with",
        );
    }
    let mut scene = cube_on_floor(DVec3::ZERO);
    let direction = DVec3::new(0.3, -1.0, 0.2).normalize();
    scene.insert_light(sun(direction));
    // Another cube high above the cascades towards the light, so that depth is clamped.
    add_cube(&mut scene, direction * -60.0);
    let upload = || GpuScene::new(&gpu.device, &gpu.queue, &scene, DVec3::ZERO).unwrap();
    let maps = [false, true].map(|emulate_clamp| {
        let target = DepthTarget { clamp_near: true, emulate_clamp, ..DepthTarget::default() };
        let casters = SceneCasters::with_target(&gpu.device, upload(), &target).unwrap();
        let camera = camera(DVec3::new(2.0, 2.0, 3.0), DVec3::ZERO);
        let settings = ShadowSettings { distance_m: 10.0, ..ShadowSettings::default() };
        draw_map(gpu, &Pcf::new(&gpu.device), &casters, scene.lights(), &camera, &settings, "cascades")
    });
    let clamped = maps[0].depth.iter().filter(|depth| **depth == 1.0).count();
    let differ = maps[0].depth.iter().zip(&maps[1].depth).filter(|(a, b)| (*a - *b).abs() > 1e-6).count();
    assert!(clamped > 100, "something is clamped: {clamped}");
    assert!(differ <= maps[0].depth.len() / 10_000, "{differ} of {} texels differ", maps[0].depth.len());
}
