//! Nodes, lights and deformed meshes.

use serde_json::json;

use super::model::{plain, with_primitive};
use crate::gltf_file::File;

/// Five copies of the vase in a row, each turned and scaled.
pub(super) fn instances() -> File {
    let mut file = plain();
    let copies = || (0..5).map(|copy| f32::from(copy as u8) - 2.0);
    let translations: Vec<f32> = copies().flat_map(|x| [x * 0.7, 0.0, -x.abs() * 0.4]).collect();
    let rotations: Vec<i16> = copies()
        .flat_map(|x| [0.0, (x * 0.2).sin(), 0.0, (x * 0.2).cos()].map(|q| (q * 32767.0) as i16))
        .collect();
    let scales: Vec<f32> = copies().flat_map(|x| [1.0 - 0.2 * x.abs(); 3]).collect();
    let translations = file.floats("VEC3", 3, &translations);
    let bytes: Vec<u8> = rotations.iter().flat_map(|value| value.to_le_bytes()).collect();
    let rotations = file.accessor(&bytes, 5122, "VEC4", 5);
    file.json["accessors"][rotations]["normalized"] = json!(true);
    let scales = file.floats("VEC3", 3, &scales);
    let attributes = json!({"TRANSLATION": translations, "ROTATION": rotations, "SCALE": scales});
    file.json["nodes"][1]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    file.require("EXT_mesh_gpu_instancing");
    file
}

/// A spot light whose inner cone is larger than the outer one.
pub(super) fn spot() -> File {
    let mut file = plain();
    file.json["extensions"]["KHR_lights_punctual"]["lights"] = json!([{
        "type": "spot", "intensity": 90000, "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.3},
    }]);
    file.json["nodes"][2]["translation"] = json!([1.0, 3.0, 2.0]);
    file.json["nodes"][2]["rotation"] = json!([-0.42, 0.16, 0.09, 0.89]);
    file
}

/// A thin vase that a morph target at the weight of its mesh makes as wide as the plain one.
pub(super) fn weights() -> File {
    let mut file = with_primitive(|file, vase| {
        let thin = |[x, y, z]: [f32; 3]| [x * 0.5, y, z * 0.5];
        let positions: Vec<_> = vase.positions.iter().copied().map(thin).collect();
        let deltas: Vec<_> = positions.iter().map(|[x, _, z]| [*x, 0.0, *z]).collect();
        let mut primitive = vase.primitive(file);
        primitive["attributes"]["POSITION"] = json!(file.floats("VEC3", 3, positions.as_flattened()));
        primitive["targets"] = json!([{"POSITION": file.floats("VEC3", 3, deltas.as_flattened())}]);
        primitive
    });
    file.json["meshes"][1]["weights"] = json!([1.0]);
    file
}

/// A vase at half the size, that its joint scales to the plain one.
pub(super) fn skin() -> File {
    let mut file = with_primitive(|file, vase| {
        let count = vase.positions.len();
        let small: Vec<_> = vase.positions.iter().map(|position| position.map(|x| x * 0.5)).collect();
        let mut primitive = vase.primitive(file);
        primitive["attributes"]["POSITION"] = json!(file.floats("VEC3", 3, small.as_flattened()));
        primitive["attributes"]["JOINTS_0"] = json!(file.accessor(&vec![0; count * 4], 5121, "VEC4", count));
        primitive["attributes"]["WEIGHTS_0"] =
            json!(file.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0].repeat(count)));
        primitive
    });
    let joint = file.add_root(json!({"scale": [2, 2, 2], "name": "joint"}));
    file.json["skins"] = json!([{"joints": [joint]}]);
    file.json["nodes"][1]["skin"] = json!(0);
    file
}

/// A second vase that casts its shadow alone.
pub(super) fn shadow_only() -> File {
    let mut file = plain();
    file.add_root(json!({
        "mesh": 1, "name": "hidden vase", "translation": [-0.5, 0, 0.4], "extras": {"shadow_casts": "only"}}));
    file
}

/// Points next to the triangles of the vase.
pub(super) fn points() -> File {
    let mut file = plain();
    let mut points = file.json["meshes"][1]["primitives"][0].clone();
    points["mode"] = json!(0);
    file.json["meshes"][1]["primitives"].as_array_mut().unwrap().push(points);
    file
}
