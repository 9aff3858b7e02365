//! Damaged files of each feature: they load, or fail with one line, quickly and in little memory.
//!
//! `SHADOWGRAPH_FUZZ_S` is the time for each feature in seconds, `SHADOWGRAPH_FUZZ_SEED` the seed.
#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout, reason = "tests")]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use shadowgraph::scene::gltf;
use shadowgraph_tests::features::{FEATURES, Feature, damaged};
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

/// Loads damaged variations of a file until the time is over.
fn fuzz(feature: Feature, directory: &Path, time: Duration, random: &mut Random) -> (usize, usize) {
    let file = (feature.file)();
    let (start, mut loads, mut loaded) = (Instant::now(), 0, 0);
    while start.elapsed() < time {
        let path = directory.join("scene.glb");
        fs::write(&path, damaged(&file, random).glb()).unwrap();
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
