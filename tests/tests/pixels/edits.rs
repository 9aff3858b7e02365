//! A scene that is edited between frames is drawn like a new one.

use super::stage::*;
use glam::{DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::{AlphaMode, Image, Instance, LightKind, Material, Scene, TextureRef};
use shadowgraph::shadows::{PCF, RAYTRACED, TechniqueKind};
use shadowgraph::{Renderer, ViewOptions};
use shadowgraph_tests::edits::{edit, transform};
use shadowgraph_tests::random::Random;

/// Returns a floor with boxes of several materials in a sun and a point light.
fn scene() -> Scene {
    let mut scene = cube_on_floor(DVec3::ZERO);
    let rgba8 =
        (0..64).flat_map(|i| [255, 255, 255, if (i / 2 + i / 16) % 2 == 0 { 255 } else { 0 }]).collect();
    let image = scene.insert_image(Image::new("checks", 8, 8, rgba8)).unwrap();
    let texture = Some(TextureRef::new(image));
    let clip = Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, base_color_texture: texture, ..material() };
    let glass = Material { alpha: AlphaMode::Blend, base_color: Vec4::new(0.2, 0.7, 0.9, 0.5), ..material() };
    let materials = [material(), clip, glass].map(|material| scene.insert_material(material).unwrap());
    let cube = nth_mesh(&scene, 1);
    let mut random = Random::new(1);
    for material in materials.into_iter().cycle().take(9) {
        scene.insert_instance(Instance::new(cube, material, transform(&mut random))).unwrap();
    }
    scene.insert_light(sun(sun_direction(50.0, 40.0)));
    let kind = LightKind::Point { position_world: DVec3::new(2.0, 3.0, 2.0), range: None };
    scene.insert_light(light(kind, 30_000.0));
    scene
}

fn frames_equal_new_scenes(technique: TechniqueKind, frames: u32) {
    let Some(gpu) = gpu() else { return };
    let camera = camera(DVec3::new(4.0, 5.0, 7.0), DVec3::new(0.0, 0.3, -0.5));
    let options = ViewOptions { size_px: [96, 54], ..with_coarse_maps(hard(&view(camera, 40.0))) };
    let create = || Renderer::with_config(gpu, scene(), &options.camera, Aov::Color, technique).unwrap();
    let (mut edited, mut fresh) = (create(), create());
    let mut random = Random::new(3);
    let mut images = Vec::new();
    for frame in 0..frames {
        for _ in 0..random.below(4) {
            edit(edited.scene_mut(), &mut random).unwrap();
        }
        fresh.set_scene(gpu, edited.scene().clone()).unwrap();
        let image = edited.draw(gpu, &options).unwrap().image;
        assert!(image == fresh.draw(gpu, &options).unwrap().image, "frame {frame}");
        images.push(image);
    }
    images.dedup();
    assert!(images.len() > frames as usize / 2, "the edits are visible");
}

#[test]
fn random_edits_are_drawn_like_a_new_scene() {
    frames_equal_new_scenes(PCF, 20);
}

#[test]
fn random_edits_are_traced_like_a_new_scene() {
    frames_equal_new_scenes(RAYTRACED, 6);
}
