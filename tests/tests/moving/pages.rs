//! Virtual shadow maps that keep pages: equal to those that are drawn in every frame, at a cost in proportion to what changed.

use crate::worlds::{Pair, SIZE_PX, camera, different_pixels, edit_lights, edit_material, move_some, scene};
use crate::{frames, gpu, seed};
use glam::{DAffine3, DVec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::{
    Camera, Instance, InstanceKey, Light, LightKind, Material, Mesh, Projection, Scene,
};
use shadowgraph::shadows::{ShadowSettings, VIRTUAL, VirtualSettings};
use shadowgraph::{Gpu, RenderedFrame, Renderer, ViewOptions};
use shadowgraph_tests::edits;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::shares::in_shares;

/// The number of frames after which renderers start afresh with another scene.
const SCENE: u64 = 40;

/// The largest number of frames of one process.
const SHARE: u64 = 200;

/// Returns what a frame has counted.
fn count(frame: &RenderedFrame, name: &str) -> u32 {
    let counts = &frame.counts.shadows;
    counts.iter().find(|(counted, _)| *counted == name).unwrap_or_else(|| panic!("{name}: {counts:?}")).1
}

fn drawn_pages(frame: &RenderedFrame) -> u32 {
    count(frame, "static pages drawn") + count(frame, "composite pages drawn")
}

fn settings(random: &mut Random) -> ShadowSettings {
    let mut settings =
        ShadowSettings { distance_m: [15.0, 60.0][random.below(2) as usize], ..ShadowSettings::default() };
    let own = VirtualSettings {
        pool_mib: [4, 4, 16, 64][random.below(4) as usize],
        level_bias: [-2.0, -1.0, 0.7][random.below(3) as usize],
        penumbrae: random.below(4) == 0,
        ..VirtualSettings::default()
    };
    settings.techniques.set(&own).unwrap();
    settings
}

/// Changes a scene as a game and its editor would: some objects move most of the time, and now and then stand for a while.
fn change(scene: &mut Scene, random: &mut Random) {
    move_some(scene, random);
    match random.below(12) {
        0 => edit_material(scene, random),
        1 | 2 => edit_lights(scene, random),
        3..6 => edits::edit(scene, random).unwrap(),
        _ => {}
    }
}

/// Moves a scene and its lights far away from the origin.
fn far_away(scene: &mut Scene, offset: DVec3) {
    let keys: Vec<_> = scene.instances().map(|(key, instance)| (key, instance.world_from_local)).collect();
    for (key, transform) in keys {
        scene.move_instance(key, DAffine3::from_translation(offset) * transform).unwrap();
    }
    let mut lights = scene.lights().to_vec();
    for light in &mut lights {
        if let LightKind::Spot { position_world, .. } | LightKind::Point { position_world, .. } =
            &mut light.kind
        {
            *position_world += offset;
        }
    }
    scene.set_lights(lights);
}

#[test]
fn images_with_kept_pages_are_equal_to_the_bit_over_random_frames_while_the_camera_stands() {
    let Some(gpu) = gpu() else { return };
    if frames() > SHARE {
        let test =
            "pages::images_with_kept_pages_are_equal_to_the_bit_over_random_frames_while_the_camera_stands";
        return in_shares(test, frames() as u32, SHARE as u32);
    }
    let mut pair = Pair::new(gpu, VIRTUAL);
    let (mut kept, mut composite, mut coarser, mut images) = (0, 0, 0, Vec::new());
    for number in 0..frames().div_ceil(SCENE) {
        let random = &mut Random::new(4000 + seed() + number as u32);
        let mut world = scene(random);
        // 10 km from the origin.
        let offset = if number % 3 == 2 { DVec3::new(8e3, 100.0, -6e3) } else { DVec3::ZERO };
        far_away(&mut world, offset);
        pair.restart(gpu, &world);
        let at = |random: &mut Random| {
            DVec3::new(random.between(-7.0, 7.0), random.between(1.5, 5.0), random.between(4.0, 8.0))
        };
        let view = |eye: DVec3| camera(offset + eye, offset + DVec3::Y * 0.5, 0.9);
        let mut options =
            ViewOptions { camera: view(at(random)), size_px: SIZE_PX, shadows: settings(random) };
        for frame in 0..SCENE {
            match random.below(20) {
                0 => options.shadows = settings(random),
                // It jumps.
                1 => options.camera = view(at(random)),
                2..8 => {}
                _ if offset == DVec3::ZERO => pair.edit(random, change),
                _ => pair.edit(random, edit_lights),
            }
            let [with, without] = pair.draw(gpu, &options);
            let differ = different_pixels(&with, &without, 0);
            let counts = &with.counts.shadows;
            assert_eq!(
                differ, 0,
                "frame {frame} of scene {number}: {counts:?}, {:?}",
                without.counts.shadows
            );
            if !counts.is_empty() {
                kept += u32::from(drawn_pages(&with) < count(&with, "pages needed"));
                composite += u32::from(count(&with, "composite pages drawn") > 0);
                coarser += u32::from(count(&with, "coarsening, quarters of a level") > 0);
            }
            images.push(with.image);
        }
    }
    let all = images.len();
    images.dedup();
    println!(
        "soak: {all} equal frames, {} of them unlike the one before; in {kept} pages were kept, in {composite} composite pages drawn, {coarser} \
         were coarser for lack of pages",
        images.len()
    );
    let all = all as u32;
    assert!(images.len() as u32 * 3 > all, "the changes are visible");
    assert!(kept * 2 > all && composite * 8 > all && coarser * 20 > all, "{kept}, {composite}, {coarser}");
}

#[test]
fn images_with_kept_pages_are_those_of_a_cold_cache_while_the_camera_moves() {
    let Some(gpu) = gpu() else { return };
    if frames() > SHARE {
        let test = "pages::images_with_kept_pages_are_those_of_a_cold_cache_while_the_camera_moves";
        return in_shares(test, frames() as u32, SHARE as u32);
    }
    let mut pair = Pair::new(gpu, VIRTUAL);
    let (mut differ, mut pixels, mut kept) = (0, 0, 0);
    for number in 0..frames().div_ceil(SCENE) {
        let random = &mut Random::new(6000 + seed() + number as u32);
        pair.restart(gpu, &scene(random));
        let mut eye = DVec3::new(random.between(-3.0, 3.0), 1.7, 7.0);
        let mut heading = random.between(-0.3, 0.3);
        let shadows = settings(random);
        for _ in 0..SCENE {
            heading += random.between(-0.04, 0.04);
            let ahead = DVec3::new(heading.sin(), -0.2, -heading.cos());
            eye += ahead * random.between(0.0, 0.2) * DVec3::new(1.0, 0.0, 1.0);
            let shadows = shadows.clone();
            let options = ViewOptions { camera: camera(eye, eye + ahead, 0.9), size_px: SIZE_PX, shadows };
            if random.below(4) == 0 {
                pair.edit(random, change);
            }
            let [with, without] = pair.draw(gpu, &options);
            differ += different_pixels(&with, &without, 2);
            pixels += u64::from(SIZE_PX[0] * SIZE_PX[1]);
            if !with.counts.shadows.is_empty() {
                kept += u32::from(drawn_pages(&with) < count(&with, "pages needed"));
            }
        }
    }
    println!(
        "soak: {differ} of {pixels} pixels differ by more than 2 of 255; in {kept} frames pages were kept"
    );
    assert!(differ as u64 * 100_000 <= pixels, "{differ} of {pixels} pixels");
    assert!(u64::from(kept) * 2 > frames());
}

/// Returns a floor with boxes in a sun; the first box stands in front of the camera.
fn field(count: usize, half_m: f64) -> (Scene, InstanceKey) {
    let mut scene = Scene::default();
    let random = &mut Random::new(1);
    let material = scene.insert_material(Material::default()).unwrap();
    let floor = DVec3::new(half_m, 0.0, half_m);
    let floor = scene.insert_mesh(Mesh::cuboid(-floor - DVec3::Y, floor));
    let cube = scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, DVec3::ONE));
    scene.insert_instance(Instance::new(floor, material, DAffine3::IDENTITY)).unwrap();
    let mut first = None;
    for index in 0..count {
        let at = DVec3::new(random.between(-half_m, half_m), 0.0, random.between(-half_m, half_m));
        let at = DAffine3::from_translation(if index == 0 { DVec3::ZERO } else { at })
            * DAffine3::from_scale(DVec3::new(0.5, random.between(0.5, 3.0), 0.5));
        let key = scene.insert_instance(Instance::new(cube, material, at)).unwrap();
        first.get_or_insert(key);
    }
    let kind = LightKind::Directional { direction: DVec3::new(0.4, -1.0, 0.3).normalize() };
    scene.set_lights([Light {
        name: None,
        kind,
        color: glam::Vec3::ONE,
        intensity: 2e4,
        casts_shadow: true,
    }]);
    (scene, first.unwrap())
}

fn view(eye: DVec3, heading: f64) -> ViewOptions {
    let ahead = DVec3::new(heading.sin(), -0.1, -heading.cos());
    ViewOptions { camera: camera(eye, eye + ahead, 0.9), size_px: [320, 180], shadows: Default::default() }
}

fn renderer(gpu: &Gpu, scene: Scene) -> Renderer {
    Renderer::with_config(gpu, scene, &view(DVec3::Y, 0.0).camera, Aov::Color, VIRTUAL).unwrap()
}

#[test]
fn one_moving_instance_among_10_000_costs_at_most_a_fiftieth_of_the_draws_and_a_still_scene_none() {
    let Some(gpu) = gpu() else { return };
    let (scene, fox) = field(10_000, 40.0);
    let mut renderer = renderer(gpu, scene);
    let options = view(DVec3::new(0.0, 3.0, 8.0), 0.0);
    let first = renderer.draw(gpu, &options).unwrap();
    let redraw = count(&first, "casters drawn into pages");
    assert!(redraw > 3_000 && drawn_pages(&first) == count(&first, "pages needed"), "{:?}", first.counts);
    for step in 1..5 {
        let at = DAffine3::from_translation(DVec3::X * 0.1 * f64::from(step));
        renderer.scene_mut().move_instance(fox, at).unwrap();
        let moved = renderer.draw(gpu, &options).unwrap();
        let draws = count(&moved, "casters drawn into pages");
        // The first step draws the static casters without it.
        if step > 1 {
            println!("{draws} of {redraw} draws");
            assert!(draws > 0 && draws * 50 <= redraw, "{:?}", moved.counts.shadows);
            assert_eq!(count(&moved, "static pages drawn"), 0);
        }
    }
    let still = renderer.draw(gpu, &options).unwrap();
    assert_eq!([drawn_pages(&still), count(&still, "casters drawn into pages")], [0, 0]);
}

#[test]
fn a_camera_that_walks_draws_at_most_a_twentieth_of_the_resident_pages_in_a_frame() {
    let Some(gpu) = gpu() else { return };
    let mut renderer = renderer(gpu, field(400, 100.0).0);
    let (mut drawn, mut resident) = (0, 0);
    // 1.4 m/s, 60 frames a second, along a bend, with the head going up and down.
    for frame in 0..120 {
        let seconds = f64::from(frame) / 60.0;
        let bob_m = 0.03 * (12.0 * seconds).sin();
        let eye = DVec3::new(2.0 * (0.3 * seconds).sin(), 1.7 + bob_m, 8.0 - 1.4 * seconds);
        let options = view(eye, 0.6 * (0.5 * seconds).sin());
        let image = renderer.draw(gpu, &options).unwrap();
        if frame > 0 {
            drawn += drawn_pages(&image);
            resident += count(&image, "pages resident");
        }
    }
    let fraction = f64::from(drawn) / f64::from(resident);
    println!("{:.2} % of the resident pages drawn in a frame", 100.0 * fraction);
    assert!(drawn > 0 && fraction <= 0.05, "{fraction}");
}

/// Counts the pixels of an image that are much darker than its brightest one.
fn dark_pixels(frame: &RenderedFrame) -> usize {
    let pixels = || frame.image.rgba8.chunks_exact(4);
    let brightest = pixels().map(|pixel| pixel[1]).max().unwrap_or(0);
    pixels().filter(|pixel| pixel[1] < brightest / 2).count()
}

/// Returns a view of 4 m around a point on the ground, from far above it and nearly along the light of [`field`].
fn through_a_long_lens(height_m: f64) -> ViewOptions {
    let eye = DVec3::new(-0.2, 1.0, -0.2) * height_m;
    let projection =
        Projection::Perspective { fov_y: 2.0 * (2.0 / eye.length()).atan(), near: 1.0, far: None };
    let camera = Camera::look_at(eye + DVec3::X, DVec3::X, DVec3::Z, projection);
    let shadows = ShadowSettings { distance_m: 3000.0, ..ShadowSettings::default() };
    ViewOptions { camera, size_px: SIZE_PX, shadows }
}

#[test]
fn shadows_seen_through_a_long_lens_stay_while_the_camera_rises_and_falls() {
    let Some(gpu) = gpu() else { return };
    let mut pair = Pair::new(gpu, VIRTUAL);
    pair.restart(gpu, &field(60, 6.0).0);
    let mut dark = Vec::new();
    // From 50 m to 1 km and back.
    for step in (1..=20).chain((1..20).rev()) {
        let height_m = 50.0 * f64::from(step);
        let [with, without] = pair.draw(gpu, &through_a_long_lens(height_m));
        assert_eq!(different_pixels(&with, &without, 2), 0, "at {height_m} m");
        dark.push(dark_pixels(&with));
    }
    println!("{dark:?} dark pixels");
    let (least, most) = (dark.iter().min().unwrap(), dark.iter().max().unwrap());
    assert!(*least > 100 && most - least <= 20, "{dark:?} dark pixels");
}
