//! Import of skins and morph targets, and errors of malformed ones.

use glam::{DAffine3, DVec3};
use serde_json::json;
use shadowgraph_scene::{Influence, Mesh, MorphDelta, Scene};

use crate::builder::File;
use crate::rejections::assert_rejected;

/// A triangle that two joints move, with 4 influences of each vertex.
fn skinned() -> File {
    let mut file = File::triangle();
    file.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"children": [2]}, {"translation": [0, 1, 0]}]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let columns = |y: f32| [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, y, 0.0, 1.0];
    let matrices = file.floats("MAT4", 16, &[columns(0.0), columns(-1.0)].concat());
    file.json["skins"] = json!([{"joints": [1, 2], "inverseBindMatrices": matrices}]);
    let joints = file.view(&[0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0]);
    let joints = file.accessor(joints, 5121, 3, "VEC4");
    file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    file.attribute("WEIGHTS_0", "VEC4", &[1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
    file
}

/// A triangle with two morph targets.
fn morphed() -> File {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let moved = file.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 3.0]);
    let turned = file.floats("VEC3", 3, &[0.1, 0.0, 0.0, 0.2, 0.0, 0.0, 0.3, 0.0, 0.0]);
    let targets = json!([{"POSITION": moved}, {"NORMAL": turned, "TANGENT": turned}]);
    file.json["meshes"][0]["primitives"][0]["targets"] = targets;
    file.json["meshes"][0]["weights"] = json!([0.5, 0.25]);
    file
}

fn mesh(scene: &Scene) -> &Mesh {
    scene.meshes().next().unwrap().1
}

fn influence(joint: u32, weight: f32) -> Influence {
    Influence { joint, weight }
}

#[test]
fn skins_have_joints_and_inverse_bind_matrices() {
    let scene = skinned().load().unwrap();
    let skin = &scene.hierarchy.skins[0];
    assert_eq!(skin.joints, [1, 2]);
    assert_eq!(skin.inverse_bind, [DAffine3::IDENTITY, DAffine3::from_translation(DVec3::NEG_Y)]);
    assert_eq!(scene.hierarchy.nodes[0].skin, Some(0));
    let weights = mesh(&scene).skin.as_ref().unwrap();
    let used: Vec<_> = (0..3).map(|i| weights.vertex(i)).map(|vertex| [vertex[0], vertex[1]]).collect();
    let expected = [
        [influence(0, 1.0), influence(0, 0.0)],
        [influence(0, 0.5), influence(1, 0.5)],
        [influence(0, 0.0), influence(1, 1.0)],
    ];
    assert_eq!((weights.per_vertex(), used), (4, expected.to_vec()));
}

#[test]
fn joints_and_weights_of_every_component_type_are_read() {
    let expected = skinned().load().unwrap();
    let wide = |bytes: &[u8]| bytes.iter().flat_map(|byte| [*byte, 0]).collect::<Vec<_>>();
    let joints = [0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0];
    for (component, max) in [(5121, vec![255]), (5123, vec![255, 255])] {
        let mut file = skinned();
        let view = file.view(&wide(&joints));
        let joints = file.accessor(view, 5123, 3, "VEC4");
        let zero = vec![0; max.len()];
        // The second vertex has equal weights that add up to less than 1.
        let half = max.clone();
        let weights: Vec<u8> =
            [&max, &zero, &zero, &zero, &half, &half, &zero, &zero, &zero, &max, &zero, &zero]
                .into_iter()
                .flatten()
                .copied()
                .collect();
        let view = file.view(&weights);
        let weights = file.accessor(view, component, 3, "VEC4");
        file.json["accessors"][weights]["normalized"] = json!(true);
        let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
        (attributes["JOINTS_0"], attributes["WEIGHTS_0"]) = (json!(joints), json!(weights));
        assert_eq!(mesh(&file.load().unwrap()).skin, mesh(&expected).skin, "{component}");
    }
}

#[test]
fn eight_influences_are_read_and_more_give_a_note() {
    let mut file = skinned();
    let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
    for set in [1, 2] {
        attributes[format!("JOINTS_{set}")] = attributes["JOINTS_0"].clone();
        attributes[format!("WEIGHTS_{set}")] = attributes["WEIGHTS_0"].clone();
    }
    let scene = file.load().unwrap();
    let weights = mesh(&scene).skin.as_ref().unwrap();
    assert_eq!(weights.per_vertex(), 8);
    assert_eq!(
        weights.influences()[8..14].iter().map(|i| i.weight).collect::<Vec<_>>(),
        [0.25, 0.25, 0.0, 0.0, 0.25, 0.25]
    );
    assert!(scene.notes.iter().any(|note| note.contains("after the eighth")), "{:?}", scene.notes);
}

#[test]
fn flat_normals_keep_the_influences_and_displacements_of_each_corner() {
    let mut file = skinned();
    let moved = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0]);
    file.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": moved}]);
    file.bin[36..42].copy_from_slice(&[2, 0, 0, 0, 1, 0]);
    let scene = file.load().unwrap();
    let mesh = mesh(&scene);
    assert_eq!(mesh.vertices[0].position, [0.0, 1.0, 0.0]);
    let joints: Vec<_> = (0..3).map(|i| mesh.skin.as_ref().unwrap().vertex(i)[1].joint).collect();
    assert_eq!(joints, [1, 0, 1]);
    let deltas = mesh.morph_targets[0].deltas();
    assert_eq!(deltas.iter().map(|delta| delta.position[2]).collect::<Vec<_>>(), [-1.0, 0.0, 0.0]);
    // Displaced, the triangle faces (0, 1, 1).
    let half = std::f32::consts::FRAC_1_SQRT_2;
    for delta in deltas {
        assert!(
            (delta.normal[1] - half).abs() < 1e-6 && (delta.normal[2] - half + 1.0).abs() < 1e-6,
            "{delta:?}"
        );
    }
}

#[test]
fn morph_targets_have_displacements_and_the_weights_of_node_or_mesh() {
    let mut file = morphed();
    let scene = file.load().unwrap();
    let targets = &mesh(&scene).morph_targets;
    let expected = MorphDelta { position: [0.0, 0.0, 2.0], ..MorphDelta::default() };
    assert_eq!(targets[0].deltas()[1], expected);
    // Without tangents, their displacements are ignored.
    assert_eq!(targets[1].deltas()[2], MorphDelta { normal: [0.3, 0.0, 0.0], ..MorphDelta::default() });
    assert_eq!(scene.hierarchy.nodes[0].weights, [0.5, 0.25]);
    file.json["nodes"][0]["weights"] = json!([1.0, 2.0]);
    assert_eq!(file.load().unwrap().hierarchy.nodes[0].weights, [1.0, 2.0]);
    file.json["nodes"][0].as_object_mut().unwrap().remove("weights");
    file.json["meshes"][0].as_object_mut().unwrap().remove("weights");
    assert_eq!(file.load().unwrap().hierarchy.nodes[0].weights, [0.0, 0.0]);
}

#[test]
fn morph_targets_can_be_sparse_and_their_weights_animated() {
    let mut file = morphed();
    let (indices, values) = (file.view(&[2, 0, 0, 0]), file.view_f32(&[7.0, 8.0, 9.0]));
    let sparse = json!({
        "count": 1,
        "indices": {"bufferView": indices, "componentType": 5121},
        "values": {"bufferView": values},
    });
    file.json["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse}));
    let accessor = file.json["accessors"].as_array().unwrap().len() - 1;
    file.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = json!(accessor);
    let input = file.floats("SCALAR", 1, &[0.0, 1.0]);
    let output = file.floats("SCALAR", 1, &[0.0, 1.0, 1.0, 0.0]);
    file.animate(0, "weights", input, output);
    let scene = file.load().unwrap();
    let positions: Vec<_> =
        mesh(&scene).morph_targets[0].deltas().iter().map(|delta| delta.position).collect();
    assert_eq!(positions, [[0.0; 3], [0.0; 3], [7.0, 8.0, 9.0]]);
    assert_eq!(scene.hierarchy.animations[0].channels[0].curve.width(), 2);
}

#[test]
fn malformed_skins_are_named() {
    let with = |change: &dyn Fn(&mut File)| {
        let mut file = skinned();
        change(&mut file);
        file
    };
    assert_rejected(
        &with(&|file| file.json["skins"][0]["joints"] = json!([1])),
        &["node 0", "needs joint 1", "1 joints"],
    );
    assert_rejected(
        &with(&|file| file.json["skins"][0]["joints"] = json!([])),
        &["skin 0", "0 joints", "1 to 65536"],
    );
    assert_rejected(
        &with(&|file| file.json["skins"][0]["joints"] = json!([1, 9])),
        &["skin 0", "joint 9", "does not exist"],
    );
    assert_rejected(
        &with(&|file| file.json["scenes"][0]["nodes"] = json!([0])),
        &["skin 0", "joint 1", "not in the drawn scene"],
    );
    assert_rejected(
        &with(&|file| file.json["nodes"][0]["skin"] = json!(1)),
        &["node 0", "skin 1", "does not exist"],
    );
    let joints = vec![1; 65_537];
    assert_rejected(
        &with(&|file| file.json["skins"][0]["joints"] = json!(joints)),
        &["skin 0", "65537 joints"],
    );
    assert_rejected(
        &with(&|file| file.json["skins"][0]["joints"] = json!([1, 2, 2])),
        &["skin 0 inverseBindMatrices (accessor 2)", "2 matrices for 3 joints"],
    );
    assert_rejected(
        &with(&|file| file.json["skins"][0]["inverseBindMatrices"] = json!(0)),
        &["skin 0 inverseBindMatrices (accessor 0)", "MAT4"],
    );
    // The first matrix begins after 44 bytes of the triangle.
    for (value, text) in [(f32::NAN, "matrix 0 is not finite"), (5.0, "last row of matrix 0")] {
        assert_rejected(
            &with(&|file| file.bin[44 + 12..44 + 16].copy_from_slice(&value.to_le_bytes())),
            &["skin 0", text],
        );
    }
}

#[test]
fn a_skin_with_the_most_joints_loads() {
    let mut file = skinned();
    file.json["skins"][0] = json!({"joints": vec![1; 65_536]});
    assert_eq!(file.load().unwrap().hierarchy.skins[0].joints.len(), 65_536);
}

#[test]
fn malformed_influences_are_named() {
    let attribute = |name: &str, kind: &str, values: &[f32]| {
        let mut file = skinned();
        file.attribute(name, kind, values);
        file
    };
    let primitive = "mesh 0 primitive 0";
    assert_rejected(
        &attribute("WEIGHTS_0", "VEC4", &[0.0; 8]),
        &[primitive, "WEIGHTS_0", "2 elements for 3 positions"],
    );
    assert_rejected(&attribute("WEIGHTS_0", "VEC4", &[-1.0; 12]), &[primitive, "weight of vertex 0 is -1"]);
    assert_rejected(
        &attribute("WEIGHTS_0", "VEC4", &[f32::NAN; 12]),
        &[primitive, "weight of vertex 0 is NaN"],
    );
    assert_rejected(&attribute("JOINTS_0", "VEC4", &[0.0; 12]), &[primitive, "JOINTS_0", "5121 or 5123"]);
    let mut file = skinned();
    let joints = file.view(&[0; 8]);
    let joints = file.accessor(joints, 5121, 2, "VEC4");
    file.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(joints);
    assert_rejected(&file, &[primitive, "JOINTS_0", "2 elements for 3 positions"]);
    let mut file = skinned();
    let attributes = &mut file.json["meshes"][0]["primitives"][0]["attributes"];
    attributes.as_object_mut().unwrap().remove("WEIGHTS_0");
    assert_rejected(&file, &[primitive, "JOINTS_0 without WEIGHTS_0"]);
}

#[test]
fn malformed_morph_targets_are_named() {
    let with = |change: &dyn Fn(&mut File)| {
        let mut file = morphed();
        change(&mut file);
        file
    };
    assert_rejected(
        &with(&|file| file.json["meshes"][0]["weights"] = json!([1.0])),
        &["mesh 0", "1 weights for 2 morph targets"],
    );
    assert_rejected(
        &with(&|file| file.json["nodes"][0]["weights"] = json!([1.0])),
        &["node 0", "1 weights for 2 morph targets"],
    );
    let targets = "/meshes/0/primitives/0/targets";
    let target = |accessor: usize| {
        with(&move |file| *file.json.pointer_mut(targets).unwrap() = json!([{"POSITION": accessor}, {}]))
    };
    assert_rejected(&target(99), &["mesh 0", "target 99", "does not exist"]);
    assert_rejected(&target(1), &["mesh 0 primitive 0 target 0 POSITION (accessor 1)", "component"]);
    assert_rejected(
        &with(&|file| {
            let short = file.floats("VEC3", 3, &[0.0; 6]);
            *file.json.pointer_mut(targets).unwrap() = json!([{"POSITION": short}, {}]);
        }),
        &["target 0 POSITION", "2 elements for 3 positions"],
    );
    assert_rejected(
        &with(&|file| {
            let wrong = file.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0]);
            *file.json.pointer_mut(targets).unwrap() = json!([{"POSITION": wrong}, {}]);
        }),
        &["target 0 POSITION", "vertex 1 is not finite"],
    );
    assert_rejected(
        &with(&|file| {
            let other = json!({"attributes": {"POSITION": 0}, "indices": 1});
            file.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(other);
        }),
        &["mesh 0 primitive 1", "0 morph targets", "allowed: 2"],
    );
    let mut file = morphed();
    let targets = vec![json!({}); 40];
    file.json["meshes"][0]["primitives"][0]["targets"] = json!(targets);
    file.json["meshes"][0].as_object_mut().unwrap().remove("weights");
    let input = file.floats("SCALAR", 1, &[0.0]);
    let output = file.floats("SCALAR", 1, &[0.0; 39]);
    file.animate(0, "weights", input, output);
    assert_rejected(&file, &["animation 0 channel 0", "39 elements for 1 keyframes", "allowed: 40"]);
    let mut file = File::triangle();
    let input = file.floats("SCALAR", 1, &[0.0]);
    file.animate(0, "weights", input, input);
    assert_rejected(&file, &["animation 0 channel 0", "without morph targets"]);
}

#[test]
fn morph_targets_are_limited_before_they_are_allocated() {
    let mut file = File::triangle();
    file.json["accessors"][0] = json!({"componentType": 5126, "count": 1000, "type": "VEC3"});
    file.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(0);
    file.json["meshes"][0]["primitives"][0]["targets"] = json!(vec![json!({}); 24_001]);
    assert_rejected(&file, &["mesh 0 primitive 0", "morph targets of the scene", "24000000"]);
}
