//! Errors for invalid values: images, lights, cameras, versions, and files that are not glTF.

use serde_json::json;

use crate::builder::File;
use crate::rejections::{assert_error_line, assert_rejected};

/// A triangle with a texture from the given URI.
pub(crate) fn textured(uri: &str) -> File {
    let mut file = File::triangle();
    file.json["images"] = json!([{"uri": uri}]);
    file.json["textures"] = json!([{"source": 0}]);
    file.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]);
    file
}

/// Asserts that the triangle is drawn without its texture, with one note that contains all of these texts.
pub(crate) fn assert_untextured(file: &File, texts: &[&str]) {
    let scene = file.load().unwrap();
    let [note] = &scene.notes[..] else { panic!("not one note: {:?}", scene.notes) };
    for text in texts {
        assert!(note.contains(text), "no {text:?} in: {note}");
    }
    let textures = scene.materials().flat_map(|(_, material)| material.textures());
    assert_eq!((scene.instances().len(), textures.flatten().count(), scene.images().len()), (1, 0, 0));
}

#[test]
fn corrupt_and_missing_images_are_left_out_and_named() {
    assert_untextured(&textured("none.png"), &["image 0 \"none.png\"", "cannot be read"]);
    let file = textured("wood.png");
    std::fs::write(file.directory.path().join("wood.png"), b"\x89PNG\r\n\x1a\n broken").unwrap();
    assert_untextured(&file, &["image 0 \"wood.png\"", "cannot be decoded"]);
    let file = textured("wood.png");
    std::fs::write(file.directory.path().join("wood.png"), b"GIF89a").unwrap();
    assert_untextured(&file, &["image 0 \"wood.png\"", "neither PNG, JPEG, WebP nor KTX2"]);
    let mut file = textured("wood.png");
    file.json["images"][0] = json!({"name": "bark"});
    assert_untextured(&file, &["image 0 \"bark\"", "neither a URI nor a bufferView"]);
}

#[test]
fn textures_without_an_image_are_left_out_and_named() {
    let mut file = textured("none.png");
    file.json["textures"][0] = json!({});
    assert_untextured(&file, &["material 0", "texture 0 has no image"]);
    file.json["textures"][0] = json!({"source": 3});
    assert_untextured(&file, &["material 0", "image 3, which does not exist"]);
    file.json["textures"] = json!([]);
    assert_untextured(&file, &["material 0", "texture 0 does not exist"]);
    file.json["materials"] = json!([]);
    file.json["textures"] = json!([{"name": "moss"}]);
    assert_untextured(&file, &["texture 0 \"moss\"", "not used"]);
}

#[test]
fn images_with_a_huge_size_are_left_out_before_decoding() {
    // A PNG header of 65535 x 65535 pixels with a valid checksum.
    let mut png = b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xff\xff\0\0\xff\xff\x08\x06\0\0\0".to_vec();
    png.extend(crc32(&png[12..]).to_be_bytes());
    png.extend(b"\0\0\0\0IDAT\x35\xaf\x06\x1e");
    let file = textured("huge.png");
    std::fs::write(file.directory.path().join("huge.png"), png).unwrap();
    assert_untextured(&file, &["image 0 \"huge.png\"", "65535x65535", "16384"]);
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xEDB8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0u32, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

#[test]
fn lights_and_cameras_out_of_range_are_named() {
    let light = |light| {
        let mut file = File::triangle();
        file.json["extensions"] = json!({"KHR_lights_punctual": {"lights": [light]}});
        file
    };
    assert_rejected(
        &light(json!({"type": "point", "intensity": -1})),
        &["light 0", "intensity is -1", "0 or more"],
    );
    assert_rejected(&light(json!({"type": "point", "range": -1})), &["light 0", "range is -1", "above 0"]);
    assert_rejected(&light(json!({"type": "spot"})), &["light 0", "spot"]);
    assert_rejected(
        &light(json!({"type": "spot", "spot": {"outerConeAngle": 2}})),
        &["light 0", "outerConeAngle", "pi/2"],
    );
    assert_rejected(&light(json!({"type": "area"})), &["light 0", "directional, point, spot"]);
    let camera = |camera| {
        let mut file = File::triangle();
        file.json["cameras"] = json!([camera]);
        file
    };
    let projection =
        |yfov: f64, znear: f64| json!({"type": "perspective", "perspective": {"yfov": yfov, "znear": znear}});
    assert_rejected(&camera(projection(4.0, 0.1)), &["camera 0", "yfov is 4", "below pi"]);
    assert_rejected(&camera(projection(1.0, 0.0)), &["camera 0", "znear is 0", "above 0"]);
    assert_rejected(&camera(json!({"type": "orthographic"})), &["camera 0", "no parameters"]);
}

#[test]
fn names_in_the_file_cannot_break_the_line_of_an_error() {
    let mut file = File::triangle();
    file.json["nodes"][0]["name"] = json!("a\nb\u{1b}[2J".repeat(1000));
    file.json["nodes"][0]["scale"] = json!([1e30, 1, 1]);
    assert_rejected(&file, &["node 0 \"a b"]);
}

#[test]
fn versions_and_required_extensions_are_named() {
    let mut file = File::triangle();
    file.json["extensionsRequired"] = json!(["ACME_one", "KHR_lights_punctual", "ACME_two"]);
    // The error must not be about a consequence of the extension.
    file.json["accessors"][0] = json!({});
    assert_rejected(
        &file,
        &["extensionsRequired", "\"ACME_one\", \"ACME_two\" are not supported", "convert"],
    );
    for version in ["1.0", "3.0", "", "2"] {
        let mut file = File::triangle();
        file.json["asset"]["version"] = json!(version);
        assert_rejected(&file, &["asset", "version", "2.0"]);
    }
}

#[test]
fn missing_files_directories_and_other_files_are_rejected() {
    let file = File::empty();
    let missing = shadowgraph_scene::gltf::load(&file.directory.path().join("none.glb"));
    assert_error_line(&file, &missing.expect_err("missing").to_string(), &["none.glb", "cannot be read"]);
    let directory = shadowgraph_scene::gltf::load(file.directory.path());
    assert_error_line(&file, &directory.expect_err("directory").to_string(), &["not a regular file"]);
    let text = file.load_bytes(b"hello").expect_err("text").to_string();
    assert_error_line(&file, &text, &["not glTF"]);
}

#[test]
fn deeply_nested_json_is_rejected() {
    let file = File::empty();
    let text = format!("{{\"asset\": {}", "[".repeat(1_000_000));
    assert_error_line(&file, &file.load_bytes(text.as_bytes()).expect_err("nested").to_string(), &["JSON"]);
}
