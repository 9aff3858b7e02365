//! A real file whose wheels turn.

use glam::{DMat3, DVec3};
use shadowgraph::Renderer;
use shadowgraph::options::Aov;
use shadowgraph::scene::{AnimationSelection, Scene};

use super::{drawn_as_new, repeated, staged};
use crate::scenes::real_scenes;
use crate::stage::{camera, gpu, view};

/// Returns the truck.
fn truck() -> Option<&'static Scene> {
    let scenes = real_scenes()?;
    Some(&scenes.iter().find(|scene| scene.name == "CesiumMilkTruck").unwrap().scene)
}

/// A wheel: where it is, and the keyframes of its angle around Z.
struct Wheel {
    position: DVec3,
    times_s: Vec<f64>,
    angles: Vec<f64>,
}

/// Reads the wheels from the bytes of the file, as its accessors say.
fn wheels() -> Vec<Wheel> {
    let bytes =
        std::fs::read(shadowgraph_tests::shared("scenes").unwrap().join("CesiumMilkTruck.glb")).unwrap();
    let word = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
    let json_end = 20 + word(12);
    let json: serde_json::Value = serde_json::from_slice(&bytes[20..json_end]).unwrap();
    let index = |value: &serde_json::Value| value.as_u64().unwrap() as usize;
    let floats = |accessor: &serde_json::Value, width: usize| -> Vec<f64> {
        let accessor = &json["accessors"][index(accessor)];
        let offset = index(&json["bufferViews"][index(&accessor["bufferView"])]["byteOffset"]);
        let first = json_end + 8 + offset + index(&accessor["byteOffset"]);
        let bits = (0..index(&accessor["count"]) * width).map(|number| word(first + number * 4) as u32);
        bits.map(|bits| f64::from(f32::from_bits(bits))).collect()
    };
    let animation = &json["animations"][0];
    let wheel = |channel: &serde_json::Value| {
        let sampler = &animation["samplers"][index(&channel["sampler"])];
        // The parent of the wheel, a root's child, has its position.
        let node = index(&channel["target"]["node"]);
        let nodes = json["nodes"].as_array().unwrap();
        let parent = nodes.iter().find(|parent| parent["children"] == serde_json::json!([node])).unwrap();
        let position = [12, 13, 14].map(|element| parent["matrix"][element].as_f64().unwrap());
        let rotations = floats(&sampler["output"], 4);
        Wheel {
            position: position.into(),
            times_s: floats(&sampler["input"], 1),
            angles: rotations.as_chunks::<4>().0.iter().map(|[_, _, z, w]| 2.0 * z.atan2(*w)).collect(),
        }
    };
    animation["channels"].as_array().unwrap().iter().map(wheel).collect()
}

impl Wheel {
    /// Returns the angle at a time: linear between two keyframes, the shorter way around.
    fn angle(&self, time_s: f64) -> f64 {
        use std::f64::consts::{PI, TAU};
        let last = self.times_s.len() - 1;
        let after = self.times_s.iter().position(|key| *key > time_s).unwrap_or(last + 1);
        if after == 0 || after > last {
            return self.angles[after.min(last)];
        }
        let [begin, end] = [after - 1, after].map(|key| self.times_s[key]);
        let difference = (self.angles[after] - self.angles[after - 1] + PI).rem_euclid(TAU) - PI;
        self.angles[after - 1] + difference * (time_s - begin) / (end - begin)
    }
}

#[test]
fn the_vertices_of_the_truck_are_within_a_tenth_of_a_millimetre_of_a_reference_in_f64() {
    let Some(mut scene) = truck().cloned() else { return };
    let wheels = wheels();
    assert_eq!(wheels.len(), 2);
    for time_s in [-1.0, 0.0, 0.31, 0.77, 1.2, 1.25, 60.0] {
        scene.set_time(AnimationSelection::All, time_s).unwrap();
        let mut turned = 0;
        for (_, instance) in scene.instances() {
            let position = instance.world_from_local.translation;
            let wheel = wheels.iter().find(|wheel| wheel.position.distance(position) < 0.1);
            turned += usize::from(wheel.is_some());
            let (position, angle) =
                wheel.map_or((DVec3::ZERO, 0.0), |wheel| (wheel.position, wheel.angle(time_s)));
            let rotation = DMat3::from_rotation_z(angle);
            for vertex in &scene.mesh(instance.mesh).unwrap().vertices {
                let local = DVec3::from(vertex.position.map(f64::from));
                let (found, expected) =
                    (instance.world_from_local.transform_point3(local), position + rotation * local);
                assert!(found.distance(expected) < 1e-4, "at {time_s} s: {found} for {expected}");
            }
        }
        assert_eq!((turned, scene.instances().len()), (2, 5));
    }
}

#[test]
fn the_truck_and_its_shadows_are_drawn_at_five_times_as_new() {
    let (Some(gpu), Some(truck)) = (gpu(), truck()) else { return };
    let mut options = view(camera(DVec3::new(4.0, 2.0, 5.0), DVec3::Y), 60.0);
    options.size_px = [160, 90];
    let scene = staged(repeated(truck, &[0.0, -9.0, -30.0]));
    for aov in [Aov::Color, Aov::Visibility(0), Aov::Visibility(1), Aov::Visibility(2)] {
        let mut renderer = Renderer::new(gpu, scene.clone(), &options.camera, aov).unwrap();
        drawn_as_new(gpu, &mut renderer, &options, [0.0, 0.25, 0.5, 0.75, 1.0], "truck");
    }
}
