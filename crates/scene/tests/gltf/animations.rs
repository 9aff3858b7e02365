//! Import of animations, and errors of malformed ones.

use std::f64::consts::FRAC_PI_2;

use glam::{DAffine3, DQuat, DVec3};
use serde_json::{Value, json};
use shadowgraph_scene::AnimationSelection::{All, None, One};
use shadowgraph_scene::{LightKind, Scene};

use crate::builder::File;
use crate::rejections::assert_rejected;

/// A triangle on node 1, a child of node 0, which an animation moves from 0 to 4 m along X, from 1 to 3 s.
fn moving() -> File {
    let mut file = File::triangle();
    file.json["nodes"] = json!([{"children": [1]}, {"mesh": 0, "translation": [0, 1, 0]}]);
    let input = file.floats("SCALAR", 1, &[1.0, 3.0]);
    let output = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]);
    file.animate(0, "translation", input, output);
    file
}

fn world(scene: &Scene) -> DAffine3 {
    scene.instances().next().unwrap().1.world_from_local
}

fn position(scene: &mut Scene, selection: shadowgraph_scene::AnimationSelection, time_s: f64) -> DVec3 {
    scene.set_time(selection, time_s).unwrap();
    world(scene).translation
}

#[test]
fn translations_are_played_and_clamped_to_the_keyframes() {
    let mut scene = moving().load().unwrap();
    assert!(scene.notes.is_empty(), "{:?}", scene.notes);
    assert_eq!(scene.hierarchy.end_s(All), 3.0);
    for (time_s, x) in [(-1.0, 0.0), (0.0, 0.0), (1.5, 1.0), (2.0, 2.0), (3.0, 4.0), (1e30, 4.0)] {
        assert_eq!(position(&mut scene, All, time_s), DVec3::new(x, 1.0, 0.0), "{time_s} s");
    }
    assert_eq!(position(&mut scene, None, 2.0), DVec3::Y);
}

#[test]
fn steps_and_splines_are_played() {
    let mut file = moving();
    file.json["animations"][0]["samplers"][0]["interpolation"] = json!("STEP");
    let mut scene = file.load().unwrap();
    let x = [2.9, 3.0].map(|time_s| position(&mut scene, All, time_s).x);
    assert_eq!(x, [0.0, 4.0]);

    let mut file = moving();
    // Keys of x = t³ at 1 and 3 s: incoming tangent, value, outgoing tangent.
    let key = |t: f32| [3.0 * t * t, 0.0, 0.0, t * t * t, 0.0, 0.0, 3.0 * t * t, 0.0, 0.0];
    let output = file.floats("VEC3", 3, &[key(1.0), key(3.0)].concat());
    file.json["animations"][0]["samplers"][0] =
        json!({"input": 2, "output": output, "interpolation": "CUBICSPLINE"});
    let mut scene = file.load().unwrap();
    for time_s in [1.0f64, 1.25, 2.0, 2.75, 3.0] {
        assert!((position(&mut scene, All, time_s).x - time_s.powi(3)).abs() < 1e-9, "{time_s} s");
    }
}

#[test]
fn rotations_of_every_component_type_turn_the_node() {
    let half = (FRAC_PI_2 / 2.0).sin();
    let integers = |max: f64| [0.0, half, 0.0, half].map(|value: f64| (value * max).round());
    let bytes = |max: f64, wide: bool| -> Vec<u8> {
        let rest = [0.0, 0.0, 0.0, max];
        let values = rest.into_iter().chain(integers(max));
        values
            .flat_map(|value| (value as u16).to_le_bytes().into_iter().take(if wide { 2 } else { 1 }))
            .collect()
    };
    for (component, max, tolerance) in
        [(5120, 127.0, 1e-2), (5121, 255.0, 1e-2), (5122, 32767.0, 1e-4), (5123, 65535.0, 1e-4)]
    {
        let mut file = moving();
        let view = file.view(&bytes(max, component >= 5122));
        let output = file.accessor(view, component, 2, "VEC4");
        file.json["accessors"][output]["normalized"] = json!(true);
        file.animate(0, "rotation", 2, output);
        let mut scene = file.load().unwrap();
        scene.set_time(One(1), 2.0).unwrap();
        let found = DQuat::from_mat3(&world(&scene).matrix3);
        let expected = DQuat::from_rotation_y(FRAC_PI_2 / 2.0);
        assert!(found.angle_between(expected) < tolerance, "{component}: {found}");
    }
}

#[test]
fn several_animations_are_played_together_or_alone() {
    let mut file = moving();
    let output = file.floats("VEC3", 3, &[1.0, 1.0, 1.0, 1.0, 9.0, 1.0]);
    let scale = file.animate(0, "scale", 2, output);
    file.json["animations"][scale]["name"] = json!("grow");
    let mut scene = file.load().unwrap();
    let names: Vec<_> =
        scene.hierarchy.animations.iter().map(|animation| animation.name.as_deref()).collect();
    assert_eq!(names, [Option::None, Some("grow")]);
    let positions = [All, One(0), One(1)].map(|selection| position(&mut scene, selection, 2.0));
    assert_eq!(positions, [[2.0, 5.0], [2.0, 1.0], [0.0, 5.0]].map(|[x, y]| DVec3::new(x, y, 0.0)));
}

#[test]
fn lights_and_cameras_move_with_their_nodes() {
    let mut file = moving();
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [{"type": "point"}]}});
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]);
    file.json["nodes"][1]["extensions"] = json!({"KHR_lights_punctual": {"light": 0}});
    file.json["nodes"][1]["camera"] = json!(0);
    let mut scene = file.load().unwrap();
    scene.set_time(All, 2.0).unwrap();
    let LightKind::Point { position_world, .. } = scene.lights()[0].kind else { panic!() };
    assert_eq!(position_world, DVec3::new(2.0, 1.0, 0.0));
    assert_eq!(scene.cameras[0].position_world(), position_world);
}

#[test]
fn channels_that_are_not_played_give_a_note() {
    let mut file = moving();
    file.json["nodes"][1] = json!({"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]});
    let output = file.json["animations"][0]["samplers"][0]["output"].as_u64().unwrap() as usize;
    let channel = |target: Value| json!({"sampler": 0, "target": target});
    file.json["animations"][0]["channels"] = json!([
        channel(json!({"path": "pointer"})),
        channel(json!({"path": "translation"})),
        channel(json!({"node": 1, "path": "translation"})),
        channel(json!({"node": 0, "path": "translation"})),
    ]);
    // A node that no scene shows.
    file.json["nodes"].as_array_mut().unwrap().push(json!({}));
    file.animate(2, "translation", 2, output);
    let mut scene = file.load().unwrap();
    let expected = [
        "animation 0 channel 0: the path \"pointer\" is not played",
        "animation 0 channel 1: a channel without a node is not played",
        "animation 0 channel 2: the transform of a node with a matrix is not played",
    ];
    assert_eq!(scene.notes, expected);
    assert_eq!(position(&mut scene, All, 2.0).x, 2.0);
}

#[test]
fn malformed_keyframes_are_named() {
    let with = |change: &dyn Fn(&mut File, &mut Value)| {
        let mut file = moving();
        let mut sampler = file.json["animations"][0]["samplers"][0].take();
        change(&mut file, &mut sampler);
        file.json["animations"][0]["samplers"][0] = sampler;
        file
    };
    let input = |times: &'static [f32]| {
        with(&move |file, sampler| sampler["input"] = json!(file.floats("SCALAR", 1, times)))
    };
    let channel = "animation 0 channel 0";
    assert_rejected(&input(&[1.0, 1.0]), &[channel, "time 1 is 1 s", "ascending"]);
    assert_rejected(&input(&[2.0, 1.0]), &[channel, "time 1 is 1 s", "ascending"]);
    assert_rejected(&input(&[-1.0, 1.0]), &[channel, "time 0 is -1 s", "at least 0"]);
    assert_rejected(&input(&[0.0, f32::NAN]), &[channel, "time 1 is NaN s", "finite"]);
    assert_rejected(&input(&[0.0, f32::INFINITY]), &[channel, "time 1 is inf s", "finite"]);
    assert_rejected(&input(&[0.0]), &[channel, "2 elements for 1 keyframes", "allowed: 1"]);
    assert_rejected(&input(&[]), &[channel, "2 elements for 0 keyframes", "allowed: 0"]);
    let output = |kind: &'static str, width, values: &'static [f32]| {
        with(&move |file, sampler| sampler["output"] = json!(file.floats(kind, width, values)))
    };
    assert_rejected(&output("VEC3", 3, &[0.0; 9]), &[channel, "3 elements for 2 keyframes"]);
    assert_rejected(&output("VEC4", 4, &[0.0; 8]), &[channel, "output (accessor 4)", "4 components"]);
    let nan = [0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0];
    assert_rejected(
        &with(&|file, sampler| sampler["output"] = json!(file.floats("VEC3", 3, &nan))),
        &[channel, "value 1 is NaN"],
    );
    let changed = |field: &'static str, value: Value| with(&move |_, sampler| sampler[field] = value.clone());
    assert_rejected(
        &changed("interpolation", json!("CUBICSPLINE")),
        &[channel, "2 elements for 2 keyframes", "allowed: 6"],
    );
    assert_rejected(&changed("interpolation", json!("BEZIER")), &[channel, "LINEAR, STEP, CUBICSPLINE"]);
    assert_rejected(&changed("input", json!(3)), &[channel, "input (accessor 3)", "single floats"]);
    assert_rejected(&changed("output", json!(77)), &["animation 0", "output 77", "0 to 3"]);
    for (field, value, text) in
        [("sampler", json!(1), "sampler 1"), ("target", json!({"node": 9, "path": "scale"}), "node 9")]
    {
        let mut file = moving();
        file.json["animations"][0]["channels"][0][field] = value;
        assert_rejected(&file, &["animation 0", text, "does not exist"]);
    }
}

#[test]
fn absurd_numbers_of_keyframes_are_rejected_without_allocating_for_them() {
    // Without a view the count cannot be checked against a number of bytes.
    let mut file = moving();
    for accessor in [2, 3] {
        file.json["accessors"][accessor].as_object_mut().unwrap().remove("bufferView");
        file.json["accessors"][accessor]["count"] = json!(4_000_000_000u64);
    }
    assert_rejected(&file, &["animation 0 channel 0", "input (accessor 2)", "4000000000 elements"]);
    // One accessor that many channels read.
    let mut file = moving();
    file.json["accessors"][3] = json!({"componentType": 5126, "count": 20_000_000, "type": "VEC3"});
    let channel = file.json["animations"][0]["channels"][0].clone();
    file.json["animations"][0]["channels"] = json!([channel.clone(), channel]);
    assert_rejected(&file, &["animation 0 channel 0", "20000000 elements for 2 keyframes"]);
}
