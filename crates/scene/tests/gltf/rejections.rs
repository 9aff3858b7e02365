//! Malformed glTF files: each gives one line that says what is wrong and where, without other effects.

use std::time::{Duration, Instant};

use proptest::prelude::*;
use serde_json::json;

use crate::builder::File;
use crate::rejected_values::{assert_untextured, textured};

/// Asserts that loading fails quickly, with one line that contains all of these texts.
pub(crate) fn assert_rejected(file: &File, texts: &[&str]) {
    let start = Instant::now();
    let error = file.load().expect_err(texts[0]).to_string();
    assert!(start.elapsed() < Duration::from_secs(10), "{error}: {:?}", start.elapsed());
    assert_error_line(file, &error, texts);
}

/// Asserts that an error is one line that begins with the file and contains all of these texts.
pub(crate) fn assert_error_line(file: &File, error: &str, texts: &[&str]) {
    assert!(error.starts_with(&file.directory.path().display().to_string()), "no file in: {error}");
    assert!(!error.contains('\n'), "more than one line: {error}");
    for text in texts {
        assert!(error.contains(text), "no {text:?} in: {error}");
    }
}

#[test]
fn references_out_of_the_directory_are_rejected() {
    for uri in ["../data.bin", "a/../../data.bin", "%2e%2e/data.bin", "/etc/hostname", "file:///etc/hostname"]
    {
        let mut file = File::triangle();
        file.json["buffers"][0]["uri"] = json!(uri);
        assert_rejected(&file, &["buffer 0", "is rejected"]);
    }
    for uri in ["http://localhost/data.bin", "https://localhost/data.bin", "//localhost/data.bin", "ftp:x"] {
        let mut file = File::triangle();
        file.json["buffers"][0]["uri"] = json!(uri);
        assert_rejected(&file, &["buffer 0", "is rejected"]);
        assert_untextured(&textured(uri), &["image 0", "is rejected"]);
    }
}

#[test]
fn cyclic_and_shared_nodes_are_rejected() {
    let with = |nodes, roots| {
        let mut file = File::triangle();
        file.json["nodes"] = nodes;
        file.json["scenes"] = json!([{"nodes": roots}]);
        file
    };
    let cycle = json!([{"children": [1]}, {"children": [0]}, {}]);
    assert_rejected(&with(cycle.clone(), json!([2])), &["node 0", "cycle"]);
    assert_rejected(&with(cycle, json!([0])), &["node 0", "cycle"]);
    assert_rejected(&with(json!([{"children": [0]}]), json!([0])), &["node 0", "cycle"]);
    assert_rejected(
        &with(json!([{"children": [2]}, {"children": [2]}, {}]), json!([0, 1])),
        &["node 2", "one parent"],
    );
    assert_rejected(&with(json!([{"children": [1, 1]}, {}]), json!([0])), &["node 1", "one parent"]);
    assert_rejected(&with(json!([{"children": [1]}, {}]), json!([0, 1])), &["scene 0", "root nodes"]);
    assert_rejected(&with(json!([{}]), json!([0, 0])), &["scene 0", "twice"]);
    assert_rejected(&with(json!([{"children": [7]}]), json!([0])), &["node 0", "child 7", "0 to 0"]);
}

#[test]
fn positions_that_are_not_finite_are_rejected() {
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut file = File::triangle();
        file.bin[12..16].copy_from_slice(&value.to_le_bytes());
        assert_rejected(&file, &["mesh 0 primitive 0 POSITION", "vertex 1", "not finite"]);
    }
}

#[test]
fn transforms_that_are_not_finite_or_too_far_are_rejected() {
    let with = |node| {
        let mut file = File::triangle();
        file.json["nodes"][0] = node;
        file
    };
    assert_rejected(&with(json!({"mesh": 0, "translation": [1e39, 0, 0]})), &["node 0", "allowed"]);
    assert_rejected(&with(json!({"mesh": 0, "scale": [1e20, 1, 1]})), &["node 0", "1e15"]);
    assert_rejected(&with(json!({"mesh": 0, "rotation": [0, 0, 0, 0]})), &["node 0", "rotation"]);
    let projective = json!({"mesh": 0, "matrix": [1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]});
    assert_rejected(&with(projective), &["node 0", "last row"]);
    let mut file = with(json!({"mesh": 0, "scale": [1e14, 1, 1]}));
    file.bin[12..16].copy_from_slice(&1e3f32.to_le_bytes());
    assert_rejected(&file, &["node 0", "1.000e17 m", "1e15 m"]);
}

#[test]
fn indices_out_of_range_are_rejected() {
    for index in [3u16, 0xFFFF] {
        let mut file = File::triangle();
        file.bin[38..40].copy_from_slice(&index.to_le_bytes());
        assert_rejected(
            &file,
            &["mesh 0 primitive 0 indices (accessor 1)", &format!("index {index} at 1"), "below 3"],
        );
    }
}

#[test]
fn truncated_files_are_rejected() {
    let file = File::triangle();
    let glb = file.glb();
    assert!(file.load_bytes(&glb).is_ok());
    for length in [0, 3, 11, 12, 19, 40, glb.len() - 40, glb.len() - 1] {
        let error = file.load_bytes(&glb[..length]).expect_err("truncated").to_string();
        assert_error_line(&file, &error, &[]);
    }
    let mut file = File::triangle();
    file.bin.truncate(20);
    assert_rejected(&file, &["buffer 0", "byteLength is 44", "20 bytes"]);
}

#[test]
fn absurd_counts_are_rejected_without_allocating_for_them() {
    for count in [5u64, 1000, u64::from(u32::MAX), u64::MAX / 12, u64::MAX] {
        for accessor in [0, 1] {
            let mut file = File::triangle();
            file.json["accessors"][accessor]["count"] = json!(count);
            let location = ["POSITION (accessor 0)", "indices (accessor 1)"][accessor];
            assert_rejected(&file, &["mesh 0 primitive 0", location, "elements"]);
        }
    }
    // Without a view the count cannot be checked against a number of bytes.
    let mut file = File::triangle();
    file.json["accessors"][0].as_object_mut().unwrap().remove("bufferView");
    file.json["accessors"][0]["count"] = json!(4_000_000_000u64);
    assert_rejected(&file, &["POSITION", "4000000000 elements"]);
    let mut file = File::triangle();
    file.json["accessors"][0]["sparse"] = json!({
        "count": u64::MAX,
        "indices": {"bufferView": 1, "componentType": 5123},
        "values": {"bufferView": 0},
    });
    assert_rejected(&file, &["POSITION", "sparse", "up to 3"]);
}

#[test]
fn views_and_accessors_beyond_their_bytes_are_rejected() {
    type Change = fn(&mut File);
    let changes: [(Change, &[&str]); 8] = [
        (
            |file| file.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX),
            &["bufferView 0", "beyond buffer 0"],
        ),
        (|file| file.json["bufferViews"][0]["byteLength"] = json!(45), &["bufferView 0", "beyond buffer 0"]),
        (|file| file.json["bufferViews"][0]["byteStride"] = json!(8), &["byteStride of 8", "12 to 252"]),
        (|file| file.json["bufferViews"][0]["byteStride"] = json!(256), &["byteStride of 256", "4 to 252"]),
        (|file| file.json["accessors"][0]["byteOffset"] = json!(u64::MAX), &["do not fit"]),
        (
            |file| file.json["accessors"][0]["type"] = json!("VEC2"),
            &["POSITION", "2 components", "allowed: 3"],
        ),
        (|file| file.json["accessors"][1]["componentType"] = json!(5122), &["indices", "unsigned"]),
        (|file| file.json["accessors"][1]["componentType"] = json!(1), &["indices", "componentType"]),
    ];
    for (change, texts) in changes {
        let mut file = File::triangle();
        change(&mut file);
        assert_rejected(&file, texts);
    }
}

#[test]
fn attributes_of_another_length_are_rejected() {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    assert_rejected(&file, &["NORMAL (accessor 2)", "2 elements for 3 positions"]);
}

#[test]
fn sparse_indices_out_of_range_are_rejected() {
    let mut file = File::triangle();
    let indices = file.view(&[3]);
    let values = file.view_f32(&[0.0; 3]);
    file.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": indices, "componentType": 5121},
        "values": {"bufferView": values},
    });
    assert_rejected(&file, &["POSITION", "sparse: index 3", "below 3"]);
}

#[test]
fn at_most_two_million_instances_are_allowed() {
    let mut file = File::triangle();
    let primitive = file.json["meshes"][0]["primitives"][0].clone();
    file.json["meshes"][0]["primitives"] = vec![primitive; 2098].into();
    file.json["nodes"] = vec![json!({"mesh": 0}); 1000].into();
    file.json["scenes"][0]["nodes"] = (0..1000).collect::<Vec<_>>().into();
    assert_rejected(&file, &["nodes", "2098000 instances", "up to 2097152"]);
}

#[test]
fn meshes_that_share_bytes_count_in_full() {
    let mut file = File::triangle();
    let view = file.view(&vec![0; 12 * 100_000]);
    let accessor = file.accessor(view, 5126, 100_000, "VEC3");
    file.json["accessors"][1]["count"] = json!(3);
    let primitive = json!({"attributes": {"POSITION": accessor}, "indices": 1});
    file.json["meshes"][0]["primitives"] = vec![primitive; 1000].into();
    assert_rejected(&file, &["mesh 0 primitive 240", "100000 elements"]);
}

/// A file that uses most of the supported features.
fn file_with_most_features() -> File {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0].repeat(3));
    file.attribute("TEXCOORD_0", "VEC2", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
    let indices = file.view(&[1]);
    let values = file.view_f32(&[2.0, 0.0, 0.0]);
    file.json["accessors"][0]["sparse"] = json!({
        "count": 1,
        "indices": {"bufferView": indices, "componentType": 5121},
        "values": {"bufferView": values},
    });
    file.json["nodes"] = json!([{"children": [1]}, {"mesh": 0, "camera": 0, "translation": [1, 2, 3]}]);
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1, "znear": 0.1}}]);
    file.json["materials"] = json!([{"normalTexture": {"index": 0}, "alphaMode": "MASK"}]);
    file.json["samplers"] = json!([{"minFilter": 9984}]);
    file
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_changed_byte_makes_the_import_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6), digits: bool,
    ) {
        let file = file_with_most_features();
        let mut glb = file.glb();
        for (index, byte) in changes {
            let index = index.index(glb.len());
            // Replacing a digit by a digit keeps the JSON valid and changes a value.
            let digit = digits && glb[index].is_ascii_digit();
            glb[index] = if digit { b'0' + byte % 10 } else { byte };
        }
        if let Err(error) = file.load_bytes(&glb) {
            prop_assert!(!error.to_string().contains('\n'));
        }
    }
}
