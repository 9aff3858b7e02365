//! Images of instances that the GPU has culled are those of instances that the CPU has culled.

use crate::worlds::{SIZE_PX, camera, different_pixels, edit_lights, edit_material, scene, settings};
use crate::{from_env, gpu, seed};
use glam::{DMat3, DVec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::{Instance, Scene};
use shadowgraph::shadows::{EVSM, PCF, PCSS, SDSM, TechniqueKind};
use shadowgraph::{Culling, Gpu, Pipeline, RenderConfig, Renderer, ViewOptions};
use shadowgraph_tests::edits;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::shares::in_shares;

/// The number of frames after which renderers start afresh with another scene.
const SCENE: u64 = 50;

/// The largest number of frames of one process.
const SHARE: u64 = 250;

/// The default number of frames.
const FRAMES: u64 = 100;

/// One renderer culls on the CPU, the other on the GPU.
struct Pair([Renderer; 2]);

impl Pair {
    fn new(gpu: &Gpu, technique: TechniqueKind, pipeline: &Pipeline) -> Self {
        let eye = camera(DVec3::Y, DVec3::ZERO, 1.0);
        Self([Culling::Cpu, Culling::Gpu].map(|culling| {
            let config = RenderConfig { culling, pipeline: pipeline.clone(), ..technique.into() };
            Renderer::with_config(gpu, Scene::default(), &eye, Aov::Color, config).unwrap()
        }))
    }

    fn edit(&mut self, random: &mut Random) {
        let before = random.clone();
        for renderer in &mut self.0 {
            *random = before.clone();
            change(renderer.scene_mut(), random);
        }
    }
}

/// Returns a scene with more boxes of few meshes and materials, some of them mirrored, far around.
fn crowd(random: &mut Random) -> Scene {
    let mut scene = scene(random);
    for _ in 0..120 {
        let nth = 1 + random.below(16) as usize;
        let Some(like) = scene.instances().nth(nth).map(|(_, instance)| instance.clone()) else { continue };
        let mut at = edits::transform(random);
        at.translation *= random.between(0.5, 8.0);
        at.translation.y = at.translation.y.min(2.0);
        if random.below(5) == 0 {
            at.matrix3.x_axis = -at.matrix3.x_axis;
        }
        scene.insert_instance(Instance { world_from_local: at, ..like }).unwrap();
    }
    // Walls that hide what is behind them.
    for _ in 0..4 {
        let Some(like) = scene.instances().nth(1).map(|(_, instance)| instance.clone()) else { continue };
        let mut at = edits::transform(random);
        at.translation *= random.between(0.5, 3.0);
        at.translation.y = 0.0;
        at.matrix3 *= DMat3::from_diagonal(DVec3::new(8.0, 4.0, 0.3));
        scene.insert_instance(Instance { world_from_local: at, ..like }).unwrap();
    }
    scene
}

/// Changes a scene as a game and its editor would: some objects move all the time.
fn change(scene: &mut Scene, random: &mut Random) {
    for _ in 0..random.below(4) {
        let nth = 1 + random.below(30) as usize;
        let Some((key, instance)) = scene.instances().nth(nth) else { continue };
        let mut moved = instance.world_from_local;
        moved.translation += DVec3::new(random.between(-0.3, 0.3), 0.0, random.between(-0.3, 0.3));
        scene.move_instance(key, moved).unwrap();
    }
    match random.below(12) {
        0 | 1 => edit_material(scene, random),
        2 | 3 => edit_lights(scene, random),
        4..8 => edits::edit(scene, random).unwrap(),
        _ => {}
    }
}

#[test]
fn images_are_equal_to_the_bit_over_random_scenes_cameras_and_edits() {
    let Some(gpu) = gpu() else { return };
    let frames = from_env("SHADOWGRAPH_SOAK").unwrap_or(FRAMES);
    if frames > SHARE {
        let test = "culling::images_are_equal_to_the_bit_over_random_scenes_cameras_and_edits";
        return in_shares(test, frames as u32, SHARE as u32);
    }
    let pipelines = [Pipeline::minimal_lit(), Pipeline::forward(), Pipeline::deferred()];
    let mut pairs: Vec<_> = [PCF, EVSM, SDSM, PCSS]
        .into_iter()
        .zip(pipelines.iter().cycle().skip(seed() as usize / 100))
        .map(|(technique, pipeline)| (technique.name, pipeline.name(), Pair::new(gpu, technique, pipeline)))
        .collect();
    let mut images = Vec::new();
    let count = pairs.len();
    for number in 0..frames.div_ceil(SCENE) {
        let (technique, pipeline, pair) = &mut pairs[number as usize % count];
        let random = &mut Random::new(7000 + seed() + number as u32);
        let world = crowd(random);
        pair.0.iter_mut().for_each(|renderer| renderer.set_scene(gpu, world.clone()).unwrap());
        let shadows = settings(random);
        // Kept tiles of a camera that moves differ by rounding, depending on when they were drawn.
        let walks = random.flip();
        let mut eye =
            DVec3::new(random.between(-7.0, 7.0), random.between(0.5, 5.0), random.between(-8.0, 8.0));
        let mut target = DVec3::Y * 0.5;
        for frame in 0..SCENE {
            if walks {
                let mut step = || random.between(-1.0, 1.0);
                (eye, target) = (
                    eye + DVec3::new(step(), 0.1 * step(), step()),
                    target + DVec3::new(step(), 0.0, step()),
                );
            }
            if random.below(3) > 0 {
                pair.edit(random);
            }
            let shadows = if walks { shadows.without_cache() } else { shadows.clone() };
            let options = ViewOptions { camera: camera(eye, target, 0.9), size_px: SIZE_PX, shadows };
            let [cpu, gpu] = pair.0.each_mut().map(|renderer| renderer.draw(gpu, &options).unwrap());
            let differ = different_pixels(&cpu, &gpu, 0);
            assert_eq!(differ, 0, "{technique}, {pipeline}, frame {frame} of scene {number}, walks: {walks}");
            images.push(gpu.image);
        }
    }
    let count = images.len();
    images.dedup();
    println!("soak: {count} equal frames, {} of them unlike the one before", images.len());
    assert!(images.len() * 2 > count, "the changes are visible");
}
