//! Import of the supported features of glTF.

use glam::{DVec3, Vec3};
use serde_json::json;
use shadowgraph_scene::gltf::{LoadOptions, Progress, load_with};
use shadowgraph_scene::{LightKind, Mesh, Projection, Scene};

use crate::builder::File;

/// Returns the first mesh.
fn mesh(scene: &Scene) -> &Mesh {
    scene.meshes().next().unwrap().1
}

fn positions(scene: &Scene) -> Vec<[f32; 3]> {
    mesh(scene).vertices.iter().map(|vertex| vertex.position).collect()
}

#[test]
fn a_triangle_without_normals_gets_flat_normals_and_a_default_material() {
    let scene = File::triangle().load().unwrap();
    assert_eq!(positions(&scene), [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    assert!(mesh(&scene).vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    let (key, material) = scene.materials().next().unwrap();
    assert_eq!((scene.materials().len(), scene.instances().next().unwrap().1.material), (1, key));
    assert_eq!(*material, shadowgraph_scene::Material::default());
    assert!(scene.notes.is_empty());
}

#[test]
fn a_glb_holds_the_same_as_its_gltf() {
    let file = File::triangle();
    assert_eq!(file.load().unwrap(), file.load_bytes(&file.glb()).unwrap());
}

#[test]
fn buffers_can_be_data_uris_and_files_in_subdirectories() {
    let mut file = File::triangle();
    let expected = file.load().unwrap();
    std::fs::create_dir(file.directory.path().join("sub directory")).unwrap();
    std::fs::write(file.directory.path().join("sub directory/b.bin"), &file.bin).unwrap();
    file.json["buffers"][0]["uri"] = json!("./sub%20directory/b.bin");
    assert_eq!(file.load().unwrap(), expected);
    let hex: String = file.bin.iter().map(|byte| format!("%{byte:02x}")).collect();
    file.json["buffers"][0]["uri"] = json!(format!("data:application/octet-stream,{hex}"));
    assert_eq!(file.load().unwrap(), expected);
}

#[test]
fn strips_fans_and_meshes_without_indices_become_lists() {
    let mut file = File::triangle();
    let view = file.view_f32(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0]);
    let accessor = file.accessor(view, 5126, 4, "VEC3");
    for (mode, triangles) in [(4, 1), (5, 2), (6, 2)] {
        file.json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": accessor}, "mode": mode});
        let scene = file.load().unwrap();
        assert_eq!(scene.triangle_count(), triangles, "mode {mode}");
    }
    file.json["meshes"][0]["primitives"][0]["mode"] = json!(5);
    let scene = file.load().unwrap();
    assert!(mesh(&scene).vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]), "the winding");
}

#[test]
fn points_and_lines_are_not_drawn_and_give_one_note() {
    let mut file = File::triangle();
    let primitive = |mode| json!({"attributes": {"POSITION": 0}, "mode": mode});
    file.json["meshes"][0]["primitives"] = json!([primitive(0), primitive(1), primitive(4), primitive(3)]);
    let scene = file.load().unwrap();
    assert_eq!((scene.meshes().len(), scene.instances().len()), (1, 1));
    assert_eq!(scene.notes, ["mesh 0 primitive 0 and 2 more: points and lines are not drawn"]);
}

#[test]
fn extensions_that_are_not_drawn_give_a_note() {
    let mut file = File::triangle();
    file.json["extensionsUsed"] = json!(["KHR_materials_unlit", "KHR_materials_clearcoat"]);
    assert_eq!(file.load().unwrap().notes, ["extensionsUsed: KHR_materials_clearcoat is not drawn"]);
}

#[test]
fn sparse_accessors_replace_single_elements() {
    let mut file = File::triangle();
    let indices = file.view(&[0, 0, 2, 0]);
    let values = file.view_f32(&[5.0, 5.0, 5.0, 7.0, 8.0, 9.0]);
    file.json["accessors"][0]["sparse"] = json!({
        "count": 2,
        "indices": {"bufferView": indices, "componentType": 5123},
        "values": {"bufferView": values},
    });
    assert_eq!(positions(&file.load().unwrap()), [[5.0, 5.0, 5.0], [1.0, 0.0, 0.0], [7.0, 8.0, 9.0]]);
    // Without a view the rest is zero.
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    assert_eq!(positions(&file.load().unwrap()), [[5.0, 5.0, 5.0], [0.0, 0.0, 0.0], [7.0, 8.0, 9.0]]);
}

#[test]
fn interleaved_and_normalised_attributes_are_read() {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 2.0].repeat(3));
    // Two 16-bit texture coordinates and three 8-bit colours for each vertex, 8 bytes apart.
    let view =
        file.view(&[[0, 0, 0xFF, 0xFF, 255, 0, 51, 9], [0xFF, 0xFF, 0, 0, 0, 255, 0, 9], [0; 8]].concat());
    file.json["bufferViews"][view]["byteStride"] = json!(8);
    let uv = file.accessor(view, 5123, 3, "VEC2");
    let color = file.accessor(view, 5121, 3, "VEC3");
    file.json["accessors"][uv]["normalized"] = json!(true);
    file.json["accessors"][color]["normalized"] = json!(true);
    file.json["accessors"][color]["byteOffset"] = json!(4);
    file.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uv);
    file.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = json!(color);
    let scene = file.load().unwrap();
    let vertices = &mesh(&scene).vertices;
    assert_eq!(vertices[0].uv1, [0.0, 1.0]);
    assert_eq!((vertices[0].color, vertices[1].color), ([65535, 0, 13107, 65535], [0, 65535, 0, 65535]));
    assert_eq!(vertices[2].normal, [0.0, 0.0, 1.0], "normalized");
}

#[test]
fn colors_are_clamped_and_invalid_values_are_replaced() {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, f32::NAN, 0.0, 0.0]);
    let colors = [2.0, -1.0, 0.5, 1.0, f32::NAN, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0];
    file.attribute("COLOR_0", "VEC4", &colors);
    file.attribute("TEXCOORD_0", "VEC2", &[f32::INFINITY, 0.5, 0.0, 0.0, 1.0, 1.0]);
    let scene = file.load().unwrap();
    let vertices = &mesh(&scene).vertices;
    assert_eq!((vertices[0].color, vertices[1].color[0]), ([65535, 0, 32768, 65535], 0));
    assert!(vertices.iter().all(|vertex| vertex.normal == [0.0, 0.0, 1.0]));
    assert_eq!(vertices[0].uv0, [0.0, 0.5]);
    assert_eq!(scene.notes.len(), 2, "{:?}", scene.notes);
}

#[test]
fn the_hierarchy_is_combined_in_f64() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([
        {"children": [1], "translation": [16_777_216, 0, 0], "scale": [2, 2, 2]},
        {"children": [2], "rotation": [0, std::f64::consts::FRAC_1_SQRT_2, 0, std::f64::consts::FRAC_1_SQRT_2]},
        {"name": "leaf", "mesh": 0, "translation": [0.25, 0, 0]},
    ]);
    let scene = file.load().unwrap();
    let (_, instance) = scene.instances().next().unwrap();
    assert_eq!(instance.name, "leaf");
    let origin = instance.world_from_local.translation;
    assert!(origin.abs_diff_eq(DVec3::new(16_777_216.0, 0.0, -0.5), 1e-6), "{origin}");
    let x = instance.world_from_local.transform_vector3(DVec3::X);
    assert!(x.abs_diff_eq(DVec3::NEG_Z * 2.0, 1e-6), "{x}");
}

#[test]
fn a_hundred_thousand_nested_nodes_load() {
    let mut file = File::triangle();
    let nodes = (1..100_000).map(|i| json!({"children": [i]})).chain([json!({"mesh": 0})]);
    file.json["nodes"] = nodes.collect::<Vec<_>>().into();
    assert_eq!(file.load().unwrap().instances().len(), 1);
}

#[test]
fn the_default_scene_is_drawn_else_the_first_else_all() {
    let mut file = File::triangle();
    file.json["nodes"] = json!([{"mesh": 0, "name": "a"}, {"mesh": 0, "name": "b"}]);
    let names = |file: &File| -> String {
        file.load().unwrap().instances().map(|(_, instance)| instance.name.as_str()).collect()
    };
    file.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}, {}]);
    assert_eq!(names(&file), "a");
    file.json["scene"] = json!(1);
    assert_eq!(names(&file), "b");
    file.json["scene"] = json!(2);
    assert_eq!(names(&file), "");
    file.json.as_object_mut().unwrap().retain(|key, _| !key.starts_with("scene"));
    assert_eq!(names(&file), "ab");
}

#[test]
fn lights_are_placed_by_their_nodes_and_ordered_by_kind() {
    let mut file = File::triangle();
    file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [
        {"type": "point", "name": "bulb", "range": 5},
        {"type": "spot", "intensity": 30, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.2}, "range": 0},
        {"type": "directional", "color": [1, 0.5, 0.25], "intensity": 3, "extensions": {"VENDOR_x": {}}},
    ]}});
    let node = |light| {
        json!({
            "name": format!("node {light}"), "translation": [light, 2, 3], "scale": [-3, 0.5, 2],
            "rotation": [-std::f64::consts::FRAC_1_SQRT_2, 0, 0, std::f64::consts::FRAC_1_SQRT_2],
            "extensions": {"KHR_lights_punctual": {"light": light}},
        })
    };
    file.json["nodes"] = json!([node(0), node(1), node(2), node(0)]);
    file.json["scenes"] = json!([{"nodes": [0, 1, 2, 3]}]);
    let scene = file.load().unwrap();
    let names: Vec<_> = scene.lights().iter().filter_map(|light| light.name.as_deref()).collect();
    assert_eq!(names, ["node 2", "node 1", "bulb", "bulb"]);
    let LightKind::Directional { direction } = scene.lights()[0].kind else { unreachable!() };
    assert!(direction.abs_diff_eq(DVec3::NEG_Y, 1e-6), "{direction}");
    assert_eq!((scene.lights()[0].color, scene.lights()[0].intensity), (Vec3::new(1.0, 0.5, 0.25), 3.0));
    let LightKind::Spot { position_world, range, inner_angle, outer_angle, .. } = scene.lights()[1].kind
    else {
        unreachable!()
    };
    assert_eq!((position_world, range), (DVec3::new(1.0, 2.0, 3.0), None));
    assert!((inner_angle - 0.1).abs() < 1e-6 && (outer_angle - 0.2).abs() < 1e-6);
    assert_eq!(scene.lights()[2].effective_range(), Some(5.0));
}

#[test]
fn cameras_are_rigid_and_in_file_order() {
    let mut file = File::triangle();
    file.json["cameras"] = json!([
        {"type": "perspective", "name": "first", "perspective": {"yfov": 0.5, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 2, "ymag": 1, "znear": 0, "zfar": 9}},
    ]);
    file.json["nodes"] = json!([
        {"camera": 1, "name": "second", "scale": [1, -2, 3], "translation": [0, 0, 4]},
        {"camera": 0, "matrix": [2, 0, 0, 0, 1, 1, 0, 0, 0, 0, 5, 0, 1, 2, 3, 1]},
    ]);
    file.json["scenes"] = json!([{"nodes": [0, 1]}]);
    let scene = file.load().unwrap();
    let names: Vec<_> = scene.cameras.iter().filter_map(|camera| camera.name.as_deref()).collect();
    assert_eq!(names, ["first", "second"]);
    assert!(matches!(scene.cameras[0].projection, Projection::Perspective { far: None, .. }));
    assert_eq!(scene.cameras[0].position_world(), DVec3::new(1.0, 2.0, 3.0));
    for camera in &scene.cameras {
        let rotation = camera.world_from_view.matrix3;
        assert!((rotation * rotation.transpose()).abs_diff_eq(glam::DMat3::IDENTITY, 1e-12));
        assert!((rotation.determinant() - 1.0).abs() < 1e-12);
        assert_eq!(camera.forward_world(), DVec3::NEG_Z);
    }
}

#[test]
fn quantised_meshes_are_read() {
    let mut file = File::triangle();
    let view = file.view(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 129, 0, 0]);
    file.json["bufferViews"][view]["byteStride"] = json!(4);
    let accessor = file.accessor(view, 5120, 3, "VEC3");
    file.json["accessors"][accessor]["normalized"] = json!(true);
    file.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = json!(accessor);
    file.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    assert_eq!(positions(&file.load().unwrap()), [[0.0; 3], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]);
}

#[test]
fn progress_runs_from_zero_to_one_in_each_stage() {
    let file = File::triangle();
    file.load().unwrap();
    let mut reported: Vec<Progress> = Vec::new();
    load_with(&file.directory.path().join("scene.gltf"), &LoadOptions::default(), &mut |progress| {
        reported.push(progress)
    })
    .unwrap();
    assert!(reported.iter().all(|progress| (0.0..=1.0).contains(&progress.fraction)));
    let sorted = |pair: &[Progress]| pair[0].stage != pair[1].stage || pair[0].fraction <= pair[1].fraction;
    assert!(reported.windows(2).all(sorted), "{reported:?}");
    assert_eq!(reported.last().map(|progress| progress.stage), Some("meshes"), "{reported:?}");
}
