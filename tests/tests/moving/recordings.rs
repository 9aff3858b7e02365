//! Recorded frames that are drawn again, to the bit.

use crate::worlds::{SIZE_PX, camera, edit_lights, edit_material, move_some, scene, settings};
use crate::{frames, gpu, seed};
use glam::DVec3;
use serde_json::json;
use shadowgraph::options::Aov;
use shadowgraph::pipelines::{Parameters, Pipeline};
use shadowgraph::recording::{Recorder, Recording};
use shadowgraph::scene::{ByName, Material, MaterialCasts, MaterialShadows, Mesh, Scene};
use shadowgraph::shadows::TechniqueKind;
use shadowgraph::{Gpu, Registry, RenderConfig, Renderer, Replay, ShadowLines, ViewOptions};
use shadowgraph_tests::random::Random;

/// The number of frames after which another renderer draws the scene.
const RENDERER: u64 = 15;

fn pipelines() -> Vec<Pipeline> {
    let everything = include_str!("../../../docs/everything.ron");
    let Registry { techniques, nodes } = Registry::built_in();
    let everything =
        Pipeline::from_text("everything.ron", everything, &nodes, &techniques, &Parameters::default());
    vec![everything.unwrap(), Pipeline::forward(), Pipeline::deferred(), Pipeline::screen_shadows()]
}

fn config(random: &mut Random) -> RenderConfig {
    let pipelines = pipelines();
    let pipeline = pipelines[random.below(pipelines.len() as u64) as usize].clone();
    let kinds: Vec<TechniqueKind> = Registry::built_in().techniques.kinds().to_vec();
    let kind = kinds[random.below(kinds.len() as u64) as usize];
    RenderConfig { technique: Some(kind.into()), pipeline, ..RenderConfig::default() }
}

/// Changes what a program gives a renderer.
fn change(gpu: &Gpu, renderer: &mut Renderer, options: &mut ViewOptions, random: &mut Random) {
    let scene = renderer.scene_mut();
    match random.below(8) {
        0 => edit_lights(scene, random),
        1 => edit_material(scene, random),
        2 => options.shadows = settings(random),
        3 => {
            let nth = random.below(scene.instances().len() as u64) as usize;
            let key = scene.instances().nth(nth).unwrap().0;
            scene.edit_instance(key, |instance| instance.visible = !instance.visible).unwrap();
        }
        4 => {
            let casts = MaterialShadows { casts: Some(MaterialCasts::Off), receives: None };
            options.shadows.materials =
                ByName(if random.flip() { vec![("*".into(), casts)] } else { vec![] });
        }
        5 => renderer.set_shadow_camera(random.flip().then(|| options.camera.clone())),
        6 => renderer.set_overlay(gpu, random.flip().then_some(ShadowLines::Frusta)).unwrap(),
        _ => move_some(scene, random),
    }
    options.camera.world_from_view.translation += DVec3::new(random.between(-0.1, 0.1), 0.0, 0.02);
}

/// Draws random frames with a recorder, and returns the scene as it was before, what was recorded, and the images.
fn record(gpu: &Gpu, random: &mut Random) -> (Scene, String, Vec<Vec<u8>>) {
    let world = scene(random);
    let mut edited = world.clone();
    let mut options = ViewOptions {
        camera: camera(DVec3::new(2.0, 3.0, 7.0), DVec3::Y * 0.5, 0.9),
        size_px: SIZE_PX,
        shadows: settings(random),
    };
    let mut recorder = Some(Recorder::new(&world, json!({ "name": "random" }), 64));
    let mut images = Vec::new();
    while (images.len() as u64) < frames() {
        edit_lights(&mut edited, random);
        let mut renderer =
            Renderer::with_config(gpu, edited, &options.camera, Aov::Color, config(random)).unwrap();
        renderer.set_recorder(recorder);
        for _ in 0..RENDERER {
            change(gpu, &mut renderer, &mut options, random);
            images.push(renderer.draw(gpu, &options).unwrap().image.rgba8);
        }
        recorder = renderer.take_recorder();
        edited = renderer.scene().clone();
    }
    let recorder = recorder.unwrap();
    assert_eq!((recorder.ended_because(), recorder.frame_count()), (None, images.len()));
    (world, recorder.text().to_owned(), images)
}

#[test]
fn recorded_frames_are_drawn_again_to_the_bit() {
    let Some(gpu) = gpu() else { return };
    let random = &mut Random::new(7100 + seed());
    let (world, text, images) = record(gpu, random);
    println!("soak: {} frames in {} KiB", images.len(), text.len() >> 10);
    let recording = Recording::parse("random", &text).unwrap();
    assert_eq!((recording.frame_count(), recording.source()), (images.len(), &json!({ "name": "random" })));
    let registry = Registry::built_in();
    let mut replay = Replay::new(&recording, world, &registry).unwrap();
    let mut differ = Vec::new();
    let mut draw = |frame: usize| {
        let (renderer, views) = replay.seek(gpu, frame).unwrap();
        if renderer.draw(gpu, &views[0]).unwrap().image.rgba8 != images[frame] {
            differ.push(frame);
        }
    };
    (0..images.len()).for_each(&mut draw);
    // Backwards, and over frames that nobody looks at.
    draw(images.len() / 3);
    draw(images.len() - 1);
    assert!(differ.is_empty(), "{differ:?}");
}

#[test]
fn a_recording_ends_where_a_scene_changes_in_another_way_and_at_its_limit() {
    let gpu = &Gpu::noop().unwrap();
    let random = &mut Random::new(1);
    let world = scene(random);
    let options = ViewOptions {
        camera: camera(DVec3::new(2.0, 3.0, 7.0), DVec3::ZERO, 0.9),
        size_px: SIZE_PX,
        shadows: settings(random),
    };
    let ended = |limit_mib: u32, frames: usize, edit: &dyn Fn(&mut Renderer)| {
        let mut renderer = Renderer::new(gpu, world.clone(), &options.camera, Aov::Color).unwrap();
        renderer.set_recorder(Some(Recorder::new(&world, json!(null), limit_mib)));
        for _ in 0..frames {
            renderer.draw(gpu, &options).unwrap();
        }
        edit(&mut renderer);
        renderer.draw(gpu, &options).unwrap();
        let recorder = renderer.take_recorder().unwrap();
        let kept = Recording::parse("kept", recorder.text()).map_or(0, |recording| recording.frame_count());
        assert_eq!(kept, recorder.frame_count());
        (recorder.ended_because(), kept)
    };
    assert_eq!(ended(1, 2, &|_| ()), (None, 3));
    let cube = || Mesh::cuboid(DVec3::ZERO, DVec3::ONE);
    let added = ended(1, 2, &|renderer| {
        renderer.scene_mut().add(cube(), Material::default(), glam::DAffine3::IDENTITY).unwrap();
    });
    assert_eq!(added, (Some("meshes or images were edited"), 2));
    let removed = ended(1, 2, &|renderer| {
        let key = renderer.scene().instances().next().unwrap().0;
        renderer.scene_mut().remove_instance(key).unwrap();
    });
    assert_eq!(removed, (Some("instances were inserted or removed"), 2));
    let replaced = ended(1, 2, &|renderer| renderer.set_scene(gpu, scene(&mut Random::new(2))).unwrap());
    assert_eq!(replaced, (Some("the scene was replaced"), 2));
    assert_eq!(ended(0, 0, &|_| ()), (Some("the limit of its memory is reached"), 0));
}

#[test]
fn damaged_recordings_are_errors_of_one_line_or_are_drawn() {
    let gpu = &Gpu::noop().unwrap();
    let random = &mut Random::new(9 + seed());
    let (world, text, _) = record(gpu, random);
    let registry = Registry::built_in();
    let lines: Vec<&str> = text.lines().take(6).collect();
    let text = lines.join("\n") + "\n";
    let mut drawn = 0;
    for _ in 0..5 * frames() {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..1 + random.below(3) {
            let at = random.below(bytes.len() as u64) as usize;
            match random.below(4) {
                0 => bytes.truncate(at.max(1)),
                1 => drop(bytes.remove(at)),
                2 => bytes[at] = b"0123456789-.eE{}[]\",:nul\n"[random.below(25) as usize],
                _ => bytes.insert(at, b'0' + random.below(10) as u8),
            }
        }
        let text = String::from_utf8_lossy(&bytes);
        let replayed = Recording::parse("damaged", &text).and_then(|recording| {
            let mut replay = Replay::new(&recording, world.clone(), &registry)?;
            replay.seek(gpu, recording.frame_count() - 1).map(drop)
        });
        match replayed {
            Ok(()) => drawn += 1,
            Err(error) => {
                let message = error.to_string();
                assert!(message.lines().count() == 1 && message.len() > 10, "{message:?}");
            }
        }
    }
    println!("soak: {drawn} of {} damaged recordings were drawn", 5 * frames());
}
