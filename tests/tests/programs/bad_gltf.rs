//! Malformed and hostile glTF files: each renders or fails with one line, quickly and in little memory.

use shadowgraph_tests::features::{FEATURES, damaged};
use shadowgraph_tests::random::Random;
use shadowgraph_tests::watch::{Limits, Outcome, run};
use shadowgraph_tests::{program, shared, skip};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

const LIMITS: Limits = Limits { time: Duration::from_secs(30), memory_bytes: 2 << 30 };
const AT_A_TIME: usize = 2;
const SIZE: (u32, u32) = (64, 36);

/// Number of damaged variations of each encoded file.
const VARIATIONS: usize = 3;

#[test]
fn every_malformed_file_renders_or_fails_with_one_line() {
    let Some(dir) = shared("bad-gltf") else {
        return skip(
            "bad_gltf",
            "no directory bad-gltf in $SHADOWGRAPH_SHARED or in shared next to the repository",
        );
    };
    let cases = cases(&dir);
    assert!(!cases.is_empty(), "{} has no case", dir.display());
    check_all(&cases);
}

#[test]
fn every_damaged_file_renders_or_fails_with_one_line() {
    const ENCODED: [&str; 7] =
        ["draco", "draco_sequential", "meshopt", "meshopt_1", "webp", "ktx2_uastc", "ktx2_etc1s"];
    let dir = tempfile::tempdir().unwrap();
    let mut random = Random::new(3);
    let mut cases = Vec::new();
    for feature in FEATURES.iter().filter(|feature| ENCODED.contains(&feature.name)) {
        let file = (feature.file)();
        for variation in 0..VARIATIONS {
            let case = dir.path().join(format!("{}_{variation}.glb", feature.name));
            std::fs::write(&case, damaged(&file, &mut random).glb()).unwrap();
            cases.push(case);
        }
    }
    assert_eq!(cases.len(), ENCODED.len() * VARIATIONS);
    check_all(&cases);
}

/// Runs all cases, and asserts what is expected of each.
fn check_all(cases: &[PathBuf]) {
    let program = program().unwrap();
    let next = AtomicUsize::new(0);
    let results = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..AT_A_TIME {
            scope.spawn(|| {
                while let Some(file) = cases.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let result = check(program, file);
                    results.lock().unwrap().push((file, result));
                }
            });
        }
    });
    summarise(results.into_inner().unwrap());
}

/// Returns the glTF or GLB file of each directory, by name.
fn cases(dir: &Path) -> Vec<PathBuf> {
    let files = |dir: &Path| std::fs::read_dir(dir).into_iter().flatten().map(|entry| entry.unwrap().path());
    let is_scene = |path: &PathBuf| path.extension().is_some_and(|end| end == "gltf" || end == "glb");
    let mut cases: Vec<PathBuf> =
        files(dir).flat_map(|case| files(&case).filter(is_scene).collect::<Vec<_>>()).collect();
    cases.sort();
    cases
}

/// Runs one case; the error lists everything that is wrong with the result.
fn check(program: &Path, file: &Path) -> Result<Outcome, String> {
    let dir = tempfile::tempdir().unwrap();
    let image = dir.path().join("case.png");
    let mut command = Command::new(program);
    command.arg("render").arg(file).arg("-o").arg(&image);
    command.args(["--size", &format!("{}x{}", SIZE.0, SIZE.1), "--adapter", adapter()]);
    // Graphics libraries print warnings where a session has no such directory.
    if std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        command.env("XDG_RUNTIME_DIR", std::env::temp_dir());
    }
    let outcome = run(&mut command, LIMITS).unwrap();
    let errors: Vec<&str> = outcome.stderr.lines().filter(|line| line.starts_with("error:")).collect();
    let left = std::fs::read_dir(dir.path()).unwrap().count();
    let mut wrong: Vec<String> = outcome.stopped.iter().map(|limit| (*limit).to_owned()).collect();
    if outcome.stderr.contains("panicked") || outcome.stderr.contains("overflowed its stack") {
        wrong.push("it panicked".to_owned());
    }
    match outcome.code {
        Some(0) => wrong.extend(image_error(&image, left, errors.len())),
        Some(1) => wrong.extend(error_message_error(file, left, &errors)),
        code => wrong.push(format!("it ended with code {code:?}")),
    }
    if wrong.is_empty() {
        Ok(outcome)
    } else {
        Err(format!("{}\n    {}", wrong.join("; "), outcome.stderr.trim()))
    }
}

fn image_error(image: &Path, files: usize, errors: usize) -> Option<String> {
    let size = image::image_dimensions(image);
    if size.as_ref().ok() != Some(&SIZE) || image::open(image).is_err() {
        Some(format!("it succeeded, but its image is {size:?}"))
    } else if files != 1 || errors > 0 {
        Some(format!("it succeeded with {errors} error lines and {files} files"))
    } else {
        None
    }
}

fn error_message_error(file: &Path, files: usize, errors: &[&str]) -> Option<String> {
    let name = file.file_name().unwrap().to_string_lossy();
    if files > 0 {
        Some(format!("it failed, but left {files} files"))
    } else if errors.len() != 1 || !errors[0].contains(&*name) {
        Some(format!("it failed with {} error lines, expected one with the file's name", errors.len()))
    } else {
        None
    }
}

/// Returns the software driver where the system has one, so that results are the same everywhere.
fn adapter() -> &'static str {
    if cfg!(target_os = "macos") { "auto" } else { "cpu" }
}

fn summarise(mut results: Vec<(&PathBuf, Result<Outcome, String>)>) {
    results.sort_by_key(|(file, _)| *file);
    let good: Vec<&Outcome> = results.iter().filter_map(|(_, result)| result.as_ref().ok()).collect();
    let drawn = good.iter().filter(|outcome| outcome.code == Some(0)).count();
    let slowest = good.iter().map(|outcome| outcome.time).max().unwrap_or_default();
    let largest = good.iter().map(|outcome| outcome.peak_bytes).max().unwrap_or_default();
    println!(
        "{} cases: {drawn} rendered, {} refused; at most {slowest:.1?} and {} MiB",
        results.len(),
        good.len() - drawn,
        largest >> 20
    );
    for (file, result) in &results {
        if let Err(wrong) = result {
            println!("{}: {wrong}", file.display());
        }
    }
    assert_eq!(good.len(), results.len(), "cases that neither rendered nor failed as expected");
}
