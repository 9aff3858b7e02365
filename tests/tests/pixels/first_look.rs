//! What the default pipeline makes of real scenes and of single objects: sky, ground, framing and exposure.

use crate::scenes::{RealScene, real_scenes};
use crate::stage::gpu;
use glam::{DAffine3, DMat4, DVec3, Vec3};
use shadowgraph::options::{Aov, GroundChoice, ShadowDistance, SunChoice};
use shadowgraph::scene::{Aabb, Camera, Light, Material, Mesh, Projection, Scene};
use shadowgraph::shadows::{NONE, PCF, RAYTRACED, SDSM, Technique, VIRTUAL};
use shadowgraph::{Background, Gpu, Pipeline, RenderConfig, RenderedImage, Renderer, ViewOptions};
use std::collections::HashSet;

const SIZE_PX: [u32; 2] = [320, 180];
const ASPECT: f64 = 16.0 / 9.0;

fn draw(gpu: &Gpu, scene: &Scene, camera: &Camera, aov: Aov, config: RenderConfig) -> RenderedImage {
    let options = ViewOptions { camera: camera.clone(), size_px: SIZE_PX, shadows: Default::default() }
        .with_shadow_distance(ShadowDistance::Auto, scene);
    let mut renderer = Renderer::with_config(gpu, scene.clone(), camera, aov, config).unwrap();
    renderer.draw(gpu, &options).unwrap().image
}

fn pixels(image: &RenderedImage) -> impl Iterator<Item = [u8; 4]> {
    image.rgba8.as_chunks::<4>().0.iter().copied()
}

/// Returns the share of the pixels for which a condition holds.
fn share(image: &RenderedImage, condition: impl Fn([u8; 4]) -> bool) -> f64 {
    let count = pixels(image).filter(|pixel| condition(*pixel)).count();
    count as f64 / pixels(image).count() as f64
}

/// Returns the share of the pixels that shadows darken visibly.
fn shadowed(with: &RenderedImage, without: &RenderedImage) -> f64 {
    let sum = |pixel: [u8; 4]| pixel[..3].iter().map(|&channel| i32::from(channel)).sum::<i32>();
    let pairs = pixels(with).zip(pixels(without));
    let count = pairs.filter(|(with, without)| sum(*with) + 3 * 8 < sum(*without)).count();
    count as f64 / pixels(with).count() as f64
}

#[test]
fn real_scenes_are_exposed_well_and_show_their_shadows() {
    let Some(gpu) = gpu() else { return };
    for RealScene { name, scene, camera } in real_scenes().unwrap_or_default() {
        let mut scene = scene.clone();
        GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
        let of = |technique| draw(gpu, &scene, camera, Aov::Color, RenderConfig::from(technique));
        let [image, lit] = [PCF, NONE].map(of);
        let white = share(&image, |[r, g, b, _]| r.max(g).max(b) == 255);
        let black = share(&image, |[r, g, b, _]| r.max(g).max(b) == 0);
        let in_shadow = shadowed(&image, &lit);
        let colors: HashSet<_> = pixels(&image).collect();
        assert!(colors.len() > 16, "{name} is more than a background: {} colours", colors.len());
        println!("{name}: white {white:.4}, black {black:.4}, in shadow {in_shadow:.4}");
        assert!(white + black < 0.02, "{name}: {white} white, {black} black");
        assert!(in_shadow > 0.002, "{name}: {in_shadow} in shadow");
    }
}

/// Returns the bounds of the instances of the largest surface area that together have 98 % of it.
fn bounds_of_most(scene: &Scene) -> Aabb {
    let mut all: Vec<_> = scene
        .instances()
        .map(|(key, instance)| {
            let mesh = scene.mesh(instance.mesh).unwrap();
            let corner = |index: u32| {
                let position = DVec3::from(mesh.vertices[index as usize].position.map(f64::from));
                instance.world_from_local.transform_point3(position)
            };
            let triangles = mesh.indices.as_chunks::<3>().0.iter().map(|triangle| triangle.map(corner));
            let area: f64 = triangles.map(|[a, b, c]| (b - a).cross(c - a).length()).sum();
            (area, scene.instance_bounds(key))
        })
        .collect();
    all.sort_by(|a, b| b.0.total_cmp(&a.0));
    let total: f64 = all.iter().map(|(area, _)| area).sum();
    let (mut bounds, mut sum) = (Aabb::EMPTY, 0.0);
    for (area, own) in all {
        if sum < 0.98 * total {
            (bounds, sum) = (bounds.union(&own), sum + area);
        }
    }
    bounds
}

/// Returns the extents of a box in the image, each 1 for the whole width or height.
fn extents(camera: &Camera, bounds: &Aabb) -> [f64; 2] {
    let clip_from_world: DMat4 = camera.clip_from_view(ASPECT) * camera.view_from_world();
    let corners = bounds.corners().map(|corner| clip_from_world.project_point3(corner));
    let seen = Aabb::from_points(corners.map(|corner| corner.clamp(DVec3::splat(-1.0), DVec3::ONE)));
    [(seen.max.x - seen.min.x) / 2.0, (seen.max.y - seen.min.y) / 2.0]
}

#[test]
fn the_camera_that_frames_real_scenes_fills_the_image() {
    for RealScene { name, scene, .. } in real_scenes().unwrap_or_default() {
        let [width, height] = extents(&scene.framing_camera(ASPECT), &bounds_of_most(scene));
        println!("{name}: {width:.2} x {height:.2}");
        assert!(width.max(height) >= 0.6, "{name}: {width} x {height}");
    }
}

/// Returns a grey cube of one metre, its framing camera, and the default sun.
fn cube() -> (Scene, Camera) {
    let mut scene = Scene::default();
    let cube = Mesh::cuboid(DVec3::ZERO, DVec3::ONE);
    scene.add(cube, Material::default(), DAffine3::IDENTITY).unwrap();
    SunChoice::default().apply(&mut scene);
    let camera = scene.framing_camera(ASPECT);
    (scene, camera)
}

fn color(gpu: &Gpu, scene: &Scene, camera: &Camera, background: Background) -> RenderedImage {
    draw(gpu, scene, camera, Aov::Color, RenderConfig { background, ..RenderConfig::default() })
}

#[test]
fn a_cube_without_a_floor_casts_its_shadow_on_the_ground() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, camera) = cube();
    let without = color(gpu, &scene, &camera, Background::Sky);
    GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
    let with = color(gpu, &scene, &camera, Background::Sky);
    let in_shadow = shadowed(&with, &without);
    assert!((0.03..0.4).contains(&in_shadow), "{in_shadow}");
}

#[test]
fn shadows_on_the_ground_are_those_of_rays_with_every_technique() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, camera) = cube();
    GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
    let image = |technique: Technique| draw(gpu, &scene, &camera, Aov::Color, technique.into());
    let rays = image(RAYTRACED.into());
    let differing = |image: &RenderedImage| {
        let pairs = pixels(image).zip(pixels(&rays));
        pairs.filter(|(a, b)| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > 24)).count()
    };
    let shadow = differing(&image(NONE.into()));
    for kind in [PCF, SDSM, VIRTUAL] {
        let plain = Technique::from(kind);
        for technique in [plain, plain.with_screen(), plain.with_contact()] {
            let wrong = differing(&image(technique));
            println!("{}: {wrong} of {shadow} pixels in shadow", technique.name());
            assert!(shadow > 1000 && wrong * 20 < shadow, "{}: {wrong} of {shadow}", technique.name());
        }
    }
}

#[test]
fn the_ground_changes_no_bit_of_images_that_are_not_in_colour() {
    let Some(gpu) = gpu() else { return };
    let (scene, camera) = cube();
    let mut on_ground = scene.clone();
    GroundChoice::Auto.place(&scene, true).add_to(&mut on_ground);
    assert!(on_ground.ground.is_some());
    for aov in ["visibility:0", "cascade", "depth", "normal", "atlas"] {
        let [first, second] = [&scene, &on_ground].map(|scene| {
            let options =
                ViewOptions { camera: camera.clone(), size_px: SIZE_PX, shadows: Default::default() };
            let mut renderer = Renderer::new(gpu, scene.clone(), &camera, aov.parse().unwrap()).unwrap();
            renderer.draw(gpu, &options).unwrap().image
        });
        assert!(first == second, "{aov}");
        let minimal = draw(gpu, &scene, &camera, aov.parse().unwrap(), Pipeline::minimal_lit().into());
        assert!(
            minimal == draw(gpu, &scene, &camera, aov.parse().unwrap(), RenderConfig::default()),
            "{aov}"
        );
    }
}

#[test]
fn a_plane_of_a_colour_is_in_all_images() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, camera) = cube();
    let depth = |scene: &Scene| draw(gpu, scene, &camera, Aov::Visibility(0), RenderConfig::default());
    let before = share(&depth(&scene), |pixel| pixel[3] == 255);
    GroundChoice::Color(Vec3::new(0.1, 0.6, 0.1)).place(&scene, false).add_to(&mut scene);
    let after = share(&depth(&scene), |pixel| pixel[3] == 255);
    assert!(before < 0.6 && after > 0.8, "{before} {after}");
    let green = color(gpu, &scene, &camera, Background::Sky);
    assert!(share(&green, |[r, g, b, _]| g > r && g > b) > 0.3);
}

#[test]
fn a_background_is_a_colour_or_transparent_with_the_shadow_on_it() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, camera) = cube();
    GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
    let white = color(gpu, &scene, &camera, Background::Color(Vec3::ONE));
    assert!(share(&white, |pixel| pixel == [255; 4]) > 0.3, "the colour is that of the image");
    let clear = color(gpu, &scene, &camera, Background::Transparent);
    let (nothing, half) = (share(&clear, |pixel| pixel[3] == 0), |[r, g, b, a]: [u8; 4]| {
        (64..250).contains(&a) && r.max(g).max(b) == 0
    });
    assert!(nothing > 0.2, "{nothing}");
    assert!(share(&clear, half) > 0.03, "the shadow is black with an opacity");
    assert!(share(&clear, |pixel| pixel[3] == 255) > 0.1, "the cube is opaque");
    // Pipelines without a sky have no ground either.
    let config = RenderConfig { background: Background::Transparent, ..Pipeline::minimal_lit().into() };
    let plain = draw(gpu, &scene, &camera, Aov::Color, config);
    assert!(share(&plain, |pixel| pixel[3] == 0) + share(&plain, |pixel| pixel[3] == 255) == 1.0);
}

#[test]
fn the_shadow_on_a_transparent_background_does_not_change_the_exposure() {
    let Some(gpu) = gpu() else { return };
    let (mut scene, camera) = cube();
    let mean = |scene: &Scene| {
        let image = color(gpu, scene, &camera, Background::Transparent);
        let opaque: Vec<f64> =
            pixels(&image).filter(|pixel| pixel[3] == 255).map(|pixel| f64::from(pixel[1])).collect();
        opaque.iter().sum::<f64>() / opaque.len() as f64
    };
    let without = mean(&scene);
    GroundChoice::Auto.place(&scene, true).add_to(&mut scene);
    let with = mean(&scene);
    // Ambient occlusion at the foot of the cube darkens a few of its pixels.
    assert!((with - without).abs() < 3.0, "{without} {with}");
}

#[test]
fn straight_alpha_restores_colours_that_were_multiplied() {
    let image = RenderedImage { size_px: [3, 1], rgba8: vec![0, 0, 0, 0, 188, 0, 188, 128, 9, 8, 7, 255] };
    assert_eq!(image.straight_alpha(), [0, 0, 0, 0, 255, 0, 255, 128, 9, 8, 7, 255]);
}

#[test]
fn sky_and_ambient_light_follow_the_sun() {
    let Some(gpu) = gpu() else { return };
    let (scene, _) = cube();
    let up = Camera {
        world_from_view: DAffine3::from_translation(DVec3::Y * 2.0) * DAffine3::from_rotation_x(0.4),
        ..scene.framing_camera(ASPECT)
    };
    let sky = |direction: DVec3, intensity: f32| {
        let mut scene = scene.clone();
        scene.set_lights(vec![Light::sun(direction.normalize(), intensity)]);
        color(gpu, &scene, &up, Background::Sky)
    };
    let mean = |image: &RenderedImage, channel: usize| {
        pixels(image).map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels(image).count() as f64
    };
    // The camera looks along -Z: the sun is in front of it, or behind.
    let (front, back) =
        (sky(DVec3::new(0.0, -0.5, 1.0), 20_000.0), sky(DVec3::new(0.0, -0.5, -1.0), 20_000.0));
    assert!(mean(&back, 2) > mean(&back, 0) + 20.0, "the sky is blue");
    let brightest = |image: &RenderedImage| pixels(image).map(|pixel| pixel[0]).max();
    assert!(brightest(&front) > brightest(&back), "the sun's disc is in front");
    // Exposure follows the sun, so the image of one a thousand times as bright is nearly the same.
    let bright = sky(DVec3::new(0.0, -0.5, -1.0), 20_000_000.0);
    assert!((mean(&bright, 2) - mean(&back, 2)).abs() < 2.0);
}

#[test]
fn exposure_brings_dark_and_bright_images_nearer_to_each_other() {
    let Some(gpu) = gpu() else { return };
    let (scene, _) = cube();
    // The key light is that of the sun, but the visible surface is dark or white.
    let with = |base: f32, pipeline: Pipeline| {
        let mut scene = scene.clone();
        let keys: Vec<_> = scene.materials().map(|(key, _)| key).collect();
        for key in keys {
            scene.edit_material(key, |material| material.base_color = Vec3::splat(base).extend(1.0)).unwrap();
        }
        let eye = DVec3::new(0.5, 0.5, 1.4);
        let projection = Projection::Perspective { fov_y: 0.8, near: 0.05, far: None };
        let near = Camera::look_at(eye, DVec3::splat(0.5), DVec3::Y, projection);
        let image = draw(gpu, &scene, &near, Aov::Color, pipeline.into());
        pixels(&image).map(|pixel| f64::from(pixel[1])).sum::<f64>() / pixels(&image).count() as f64
    };
    let range = |pipeline: fn() -> Pipeline| with(1.0, pipeline()) - with(0.02, pipeline());
    let (adapted, fixed) = (range(Pipeline::forward), range(Pipeline::minimal_lit));
    assert!(adapted < 0.8 * fixed && adapted > 20.0, "{adapted} {fixed}");
}
