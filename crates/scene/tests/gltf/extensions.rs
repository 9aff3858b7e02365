//! Extensions with invalid values: each is an error that names the object, or a note.

use serde_json::{Value, json};

use crate::builder::File;
use crate::materials::write_png;
use crate::rejections::assert_rejected;

fn with_primitive_extension(name: &str, extension: &Value) -> File {
    let mut file = File::triangle();
    file.json["meshes"][0]["primitives"][0]["extensions"] = json!({name: extension});
    file
}

#[test]
fn draco_geometry_that_cannot_be_decoded_is_named() {
    let name = "KHR_draco_mesh_compression";
    let extension = json!({"bufferView": 0, "attributes": {"POSITION": 0}});
    assert_rejected(&with_primitive_extension(name, &extension), &["mesh 0 primitive 0", name]);
    let missing = json!({"bufferView": 9, "attributes": {"POSITION": 0}});
    assert_rejected(&with_primitive_extension(name, &missing), &[name, "bufferView 9 does not exist"]);
    assert_rejected(&with_primitive_extension(name, &json!({})), &[name, "bufferView"]);
}

/// The triangle with the view of its positions compressed, as an extension says.
fn with_meshopt(extension: &Value) -> File {
    let mut file = File::triangle();
    file.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": extension});
    file
}

#[test]
fn meshopt_views_that_cannot_be_decompressed_are_named() {
    let with = |change: fn(&mut Value)| {
        let mut extension = json!({
            "buffer": 0, "byteLength": 36, "byteStride": 12, "count": 3, "mode": "ATTRIBUTES", "filter": "NONE",
        });
        change(&mut extension);
        with_meshopt(&extension)
    };
    let place = "POSITION (accessor 0)";
    assert_rejected(&with(|_| {}), &[place, "bufferView 0 cannot be decompressed"]);
    assert_rejected(&with(|e| e["count"] = json!(4)), &[place, "byteLength of 36"]);
    assert_rejected(&with(|e| e["count"] = json!(u64::MAX)), &[place, "byteLength of 36"]);
    assert_rejected(&with(|e| e["byteLength"] = json!(1u64 << 40)), &[place, "beyond buffer 0"]);
    assert_rejected(&with(|e| e["buffer"] = json!(3)), &[place, "buffer 3, which does not exist"]);
    assert_rejected(&with(|e| e["mode"] = json!("POINTS")), &[place, "EXT_meshopt_compression"]);
    assert_rejected(&with(|e| e["filter"] = json!("OCTAHEDRAL")), &[place, "cannot be decompressed"]);
}

#[test]
fn decompressed_views_are_limited() {
    let mut file = with_meshopt(&json!({
        "buffer": 0, "byteLength": 36, "byteStride": 12, "count": 1 << 28, "mode": "ATTRIBUTES",
    }));
    file.json["bufferViews"][0]["byteLength"] = json!(12u64 << 28);
    assert_rejected(&file, &["more than 1073741824, the limit"]);
}

#[test]
fn instanced_copies_with_invalid_attributes_are_named() {
    let with = |attributes: Value| {
        let mut file = File::triangle();
        let translations = file.floats("VEC3", 3, &[0.0; 6]);
        let rotations = file.floats("VEC4", 4, &[0.0; 4]);
        assert_eq!((translations, rotations), (2, 3));
        file.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
        file
    };
    let place = "node 0 EXT_mesh_gpu_instancing";
    assert_eq!(with(json!({"TRANSLATION": 2})).load().unwrap().instances().len(), 2);
    assert_rejected(
        &with(json!({"TRANSLATION": 2, "ROTATION": 3})),
        &[place, "attributes of 2 and 1 elements"],
    );
    assert_rejected(&with(json!({"ROTATION": 3})), &[place, "ROTATION 0 has the length 0"]);
    assert_rejected(&with(json!({"SCALE": 1})), &[place, "SCALE (accessor 1)"]);
    assert_rejected(&with(json!({"SCALE": 77})), &[place, "SCALE (accessor 77) does not exist"]);
    assert_rejected(&with(json!({"SCALE": "x"})), &[place, "invalid type"]);
}

#[test]
fn a_variant_with_a_material_that_does_not_exist_is_named() {
    let mapping = json!({"mappings": [{"material": 5, "variants": [0]}]});
    let file = with_primitive_extension("KHR_materials_variants", &mapping);
    assert_rejected(&file, &["mesh 0", "material of a variant 5 does not exist"]);
}

#[test]
fn materials_of_extensions_that_are_not_finite_are_named() {
    let with = |extensions: Value| {
        let mut file = File::triangle();
        file.json["materials"] = json!([{"name": "pane", "extensions": extensions}]);
        file
    };
    let glossy = json!({"KHR_materials_pbrSpecularGlossiness": {"glossinessFactor": 1e39}});
    assert_rejected(&with(glossy), &["material 0 \"pane\"", "not finite"]);
    let glass = json!({"KHR_materials_transmission": {"transmissionFactor": 1e39}});
    assert_rejected(&with(glass), &["material 0 \"pane\"", "transmissionFactor"]);
}

#[test]
fn a_transmission_texture_that_is_placed_differently_is_a_note() {
    let glass = |uv_set: u32| {
        let mut file = File::triangle();
        write_png(&file, "color.png", [255, 0, 0, 255]);
        write_png(&file, "mask.png", [255; 4]);
        file.json["images"] = json!([{"uri": "color.png"}, {"uri": "mask.png"}]);
        file.json["textures"] = json!([{"source": 0}, {"source": 1}]);
        file.json["materials"] = json!([{
            "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}},
            "extensions": {"KHR_materials_transmission": {
                "transmissionFactor": 0.5, "transmissionTexture": {"index": 1, "texCoord": uv_set}}},
        }]);
        file.load().unwrap()
    };
    assert_eq!(glass(0).notes, [""; 0]);
    let notes = glass(1).notes;
    assert!(notes.len() == 1 && notes[0].contains("placed differently"), "{notes:?}");
}
