//! Damage to the encoded bytes of a file.

use std::ops::Range;

use serde_json::Value;

use crate::gltf_file::File;
use crate::random::Random;

/// Returns a file with some of its encoded bytes changed, or cut off.
#[must_use]
pub fn damaged(file: &File, random: &mut Random) -> File {
    let (mut json, mut bytes) = (file.json.clone(), file.bytes().to_vec());
    if random.below(8) == 0 {
        shorten(&mut json, random);
    } else {
        let ranges = encoded(&json);
        damage(&mut bytes, &ranges[random.below(ranges.len() as u64) as usize], random);
    }
    File::from_parts(json, bytes)
}

/// Returns where in the buffer the encoded bytes of a file are.
fn encoded(json: &Value) -> Vec<Range<usize>> {
    let range = |object: &Value| -> Option<Range<usize>> {
        let start = object["byteOffset"].as_u64()? as usize;
        Some(start..start + object["byteLength"].as_u64()? as usize)
    };
    let views = json["bufferViews"].as_array().unwrap();
    let meshopt = views.iter().filter_map(|view| range(view["extensions"].as_object()?.values().next()?));
    let images = json["images"].as_array().into_iter().flatten();
    let images = images.filter_map(|image| range(&views[image["bufferView"].as_u64()? as usize]));
    let primitives =
        json["meshes"].as_array().unwrap().iter().flat_map(|mesh| mesh["primitives"].as_array().unwrap());
    let draco = primitives.filter_map(|primitive| {
        range(&views[primitive["extensions"]["KHR_draco_mesh_compression"]["bufferView"].as_u64()? as usize])
    });
    let (meshopt, draco): (Vec<_>, Vec<_>) = (meshopt.collect(), draco.collect());
    // The image of a file with compressed geometry is a plain one.
    if meshopt.is_empty() && draco.is_empty() { images.collect() } else { [meshopt, draco].concat() }
}

/// Damages some bytes in a range.
fn damage(bytes: &mut [u8], range: &Range<usize>, random: &mut Random) {
    let len = range.len() as u64;
    for _ in 0..=random.below(4) {
        // Headers decide the most, and are short.
        let end = if random.flip() { len.min(96) } else { len };
        let at = range.start + random.below(end) as usize;
        match random.below(5) {
            0 => bytes[at] ^= 1 << random.below(8),
            1 => bytes[at] = random.below(256) as u8,
            2 => bytes[at] = [0, 1, 127, 128, 255][random.below(5) as usize],
            3 => bytes[at] = bytes[at].wrapping_add(if random.flip() { 1 } else { 255 }),
            // A piece from elsewhere.
            _ => {
                let from = range.start + random.below(len) as usize;
                let count = (1 + random.below(16) as usize).min(range.end - at.max(from));
                bytes.copy_within(from..from + count, at);
            }
        }
    }
}

/// Shortens the encoded bytes, of which the rest is still in the buffer.
fn shorten(json: &mut Value, random: &mut Random) {
    let shorten = |object: &mut Value, random: &mut Random| {
        if let Some(len) = object["byteLength"].as_u64() {
            object["byteLength"] = Value::from(random.below(len + 1));
        }
    };
    let views = json["bufferViews"].as_array_mut().unwrap();
    let view = random.below(views.len() as u64) as usize;
    match views[view].get_mut("extensions").and_then(Value::as_object_mut) {
        Some(extensions) => extensions.values_mut().for_each(|extension| shorten(extension, random)),
        None => shorten(&mut views[view], random),
    }
}
