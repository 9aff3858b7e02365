//! Maps that keep what did not change are equal to maps that are drawn every frame.

use crate::boxes::{Block, Boxes};
use crate::maps::{Frames, View, camera, light, sun};
use crate::{frames, gpu};
use glam::DVec3;
use shadowgraph::scene::{Aabb, Light, LightKind};
use shadowgraph::shadows::{CullSettings, DepthFormat, Mobility, ShadowSettings};
use shadowgraph_tests::random::Random;

/// The number of boxes.
const BOXES: usize = 60;

/// The number of frames between changes of camera and settings.
const SCENE: u64 = 30;

fn random_box(random: &mut Random) -> Aabb {
    let min = DVec3::new(random.between(-14.0, 14.0), random.between(0.0, 4.0), random.between(-14.0, 14.0));
    let size = DVec3::new(random.between(0.2, 3.0), random.between(0.2, 3.0), random.between(0.2, 3.0));
    Aabb { min, max: min + size }
}

fn random_lights(random: &mut Random) -> Vec<Light> {
    let direction = |random: &mut Random| {
        DVec3::new(random.between(-0.8, 0.8), -1.0, random.between(-0.8, 0.8)).normalize()
    };
    let at = |random: &mut Random| DVec3::new(random.between(-9.0, 9.0), 6.0, random.between(-9.0, 9.0));
    let spot = LightKind::Spot {
        position_world: at(random),
        direction: direction(random),
        inner_angle: 0.5,
        outer_angle: 0.8,
        range: Some(20.0),
    };
    let point = LightKind::Point { position_world: at(random), range: Some(15.0) };
    vec![sun(direction(random)), light(spot, 900.0), light(point, 900.0)]
}

fn random_settings(random: &mut Random) -> ShadowSettings {
    // Without culling by view, the maps themselves are equal.
    let mut settings = ShadowSettings { cull: CullSettings::NONE, ..ShadowSettings::default() };
    settings.distance_m = 40.0;
    settings.cascades.count = 1 + random.below(4) as u32;
    settings.cascades.map_size_px = 256;
    settings.atlas.map_size_px = 256;
    // Depth24Plus cannot be read back.
    settings.cascades.depth = [DepthFormat::Depth16, DepthFormat::Depth32][random.below(2) as usize];
    settings.atlas.depth = [DepthFormat::Depth16, DepthFormat::Depth32][random.below(2) as usize];
    settings
}

/// Changes some boxes as a game would.
fn change(boxes: &mut Boxes, random: &mut Random) {
    for index in 0..boxes.blocks.len() {
        if boxes.blocks[index].mobility == Mobility::Moving && random.below(3) > 0 {
            let by =
                DVec3::new(random.between(-0.5, 0.5), random.between(-0.2, 0.2), random.between(-0.5, 0.5));
            boxes.shift(index, by);
        }
    }
    let index = random.below(boxes.blocks.len() as u64) as usize;
    let version = boxes.version();
    let Block { bounds, version: old, mobility, is_there } = &mut boxes.blocks[index];
    match random.below(10) {
        0 => *is_there = !*is_there,
        1 => {
            *mobility = match mobility {
                Mobility::Static => Mobility::Moving,
                Mobility::Moving => Mobility::Static,
            }
        }
        2 => {
            *bounds = random_box(random);
            *old = old.map(|_| version);
        }
        3 => *old = if old.is_some() { None } else { Some(version) },
        // Nothing but what moves.
        _ => {}
    }
}

#[test]
fn kept_maps_are_equal_to_the_bit_over_random_motions_of_casters_lights_and_settings() {
    let Some(gpu) = gpu() else { return };
    let (mut kept_tiles, mut stored) = (0, 0);
    for scene in 0..frames().div_ceil(SCENE) {
        let random = &mut Random::new(scene as u32);
        let mut boxes = Boxes::new(&gpu.device, BOXES);
        for index in 0..BOXES {
            let moves = if index % 12 == 0 { Mobility::Moving } else { Mobility::Static };
            boxes.add(random_box(random), moves);
        }
        let eye = DVec3::new(random.between(-8.0, 8.0), random.between(1.0, 5.0), random.between(-8.0, 8.0));
        let mut view = View {
            camera: camera(eye, DVec3::ZERO),
            lights: random_lights(random),
            settings: random_settings(random),
        };
        let (mut kept, mut drawn) =
            (Frames::new(&gpu.device, &gpu.queue), Frames::new(&gpu.device, &gpu.queue));
        for frame in 0..SCENE {
            match random.below(20) {
                0 => view.lights = random_lights(random),
                1 => view.settings = random_settings(random),
                2 | 3 => {}
                _ => change(&mut boxes, random),
            }
            let [with, without] = [(&mut kept, true), (&mut drawn, false)].map(|(frames, cache)| {
                view.settings.cascades.cache = cache;
                view.settings.atlas.cache = cache;
                frames.draw(&boxes, &view, true)
            });
            for (index, name) in ["cascades", "atlas"].into_iter().enumerate() {
                let said = crate::maps::notes(&with.plan, name);
                kept_tiles += said.iter().filter(|note| note.contains(" kept: ")).count();
                stored += said.iter().filter(|note| note.contains("; drawn: ")).count();
                let differ = with.different_tiles(&without, index);
                assert!(differ.is_empty(), "{name}: {differ:?} in frame {frame} of scene {scene}: {said:#?}");
            }
        }
    }
    println!("{kept_tiles} tiles kept, {stored} of them with moving casters added");
    assert!(kept_tiles > 100 && stored > 50, "{kept_tiles} tiles kept, {stored} with moving casters");
}
