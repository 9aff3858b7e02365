//! Damaged files of each feature: they load, or fail with one line, quickly and in little memory.
//!
//! `SHADOWGRAPH_FUZZ_S` is the time for each feature in seconds, `SHADOWGRAPH_FUZZ_SEED` the seed.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::time::{Duration, Instant};

use serde_json::Value;
use shadowgraph::scene::gltf;
use shadowgraph_tests::features::{FEATURES, Feature};
use shadowgraph_tests::gltf_file::File;
use shadowgraph_tests::random::Random;

/// More than any of the files takes on a busy machine.
const MAX_TIME: Duration = Duration::from_secs(10);
/// The memory that the process may have taken in the end, MiB.
const MAX_MEMORY_MIB: u64 = 2048;

/// Returns an integer that the environment may set.
fn from_env(variable: &str, default: u32) -> u32 {
    std::env::var(variable).map_or(default, |number| number.parse().unwrap())
}

/// Returns the largest memory that this process has had, MiB; `None` where it cannot be read.
fn peak_memory_mib() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix(" kB")?.parse::<u64>().ok()? / 1024)
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

/// Loads damaged variations of a file until the time is over.
fn fuzz(feature: Feature, directory: &Path, time: Duration, random: &mut Random) -> (usize, usize) {
    let file: File = (feature.file)();
    let (ranges, bytes) = (encoded(&file.json), file.bytes().to_vec());
    let (start, mut loads, mut loaded) = (Instant::now(), 0, 0);
    while start.elapsed() < time {
        let (mut json, mut damaged) = (file.json.clone(), bytes.clone());
        if random.below(8) == 0 {
            shorten(&mut json, random);
        } else {
            damage(&mut damaged, &ranges[random.below(ranges.len() as u64) as usize], random);
        }
        let path = directory.join("scene.glb");
        fs::write(&path, File::from_parts(json, damaged.clone()).glb()).unwrap();
        let begin = Instant::now();
        let result = std::panic::catch_unwind(|| gltf::load(&path));
        let duration = begin.elapsed();
        loads += 1;
        loaded += usize::from(matches!(result, Ok(Ok(_))));
        let one_line = match &result {
            Ok(result) => result.as_ref().err().is_none_or(|error| !error.to_string().contains('\n')),
            Err(_) => false,
        };
        if !one_line || duration > MAX_TIME {
            let kept = std::env::temp_dir().join(format!("damaged-{}.glb", feature.name));
            fs::copy(&path, &kept).unwrap();
            panic!("{feature:?}: {result:?} after {duration:?} for {}", kept.display());
        }
    }
    (loads, loaded)
}

/// Fuzzes the files of a feature.
fn fuzz_feature(name: &str) {
    let feature = *FEATURES.iter().find(|feature| feature.name == name).unwrap();
    let directory = tempfile::tempdir().unwrap();
    let mut random = Random::new(from_env("SHADOWGRAPH_FUZZ_SEED", 1));
    let time = Duration::from_secs(from_env("SHADOWGRAPH_FUZZ_S", 1).into());
    let (loads, loaded) = fuzz(feature, directory.path(), time, &mut random);
    let memory = peak_memory_mib();
    println!("{name}: {loads} damaged files, {loaded} of them drawn, at most {memory:?} MiB");
    assert!(loads > 10 && memory.is_none_or(|memory| memory < MAX_MEMORY_MIB));
}

#[test]
fn damaged_draco_edgebreaker() {
    fuzz_feature("draco");
}

#[test]
fn damaged_draco_sequential() {
    fuzz_feature("draco_sequential");
}

#[test]
fn damaged_meshopt() {
    fuzz_feature("meshopt");
}

#[test]
fn damaged_meshopt_version_1() {
    fuzz_feature("meshopt_1");
}

#[test]
fn damaged_webp() {
    fuzz_feature("webp");
}

#[test]
fn damaged_ktx2_uastc() {
    fuzz_feature("ktx2_uastc");
}

#[test]
fn damaged_ktx2_etc1s() {
    fuzz_feature("ktx2_etc1s");
}
