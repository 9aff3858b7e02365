//! `cargo xtask gpu-report`: a directory that measures a GPU on another Linux machine, without a network.

use crate::child;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The directory, relative to the repository's root.
const DIRECTORY: &str = "out/gpu-report";

/// Files of the repository that the pixel tests read.
const FILES: [&str; 1] = ["docs/everything.ron"];

/// Scene of the collection of real scenes that is measured, if this machine has it.
const SCENE: &str = "scenes/kaykit_dungeon_hall.glb";

/// Cargo's arguments for each program before the name of its target, that name, and its name in the directory.
const PROGRAMS: [(&[&str], &str, &str); 3] = [
    (&["build", "--package", "shadowgraph-tests", "--bin"], "gpu_report", "gpu-report"),
    (
        &["build", "--no-default-features", "--package", "shadowgraph-cli", "--bin"],
        "shadowgraph",
        "shadowgraph",
    ),
    (&["test", "--no-run", "--package", "shadowgraph-tests", "--test"], "pixels", "pixels"),
];

const NEXT: &str = "\
Copy the directory to a Linux machine with a GPU and a Vulkan driver, and run ./gpu-report in it (--help lists its options).
";

pub(crate) fn run() -> ExitCode {
    match build() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn build() -> Result<(), String> {
    let directory = child::root().join(DIRECTORY);
    // Programs of an earlier build must not stay.
    let _absent = std::fs::remove_dir_all(&directory);
    for (arguments, target, name) in PROGRAMS {
        println!("Building {name} ...");
        let mut command = child::cargo(arguments);
        command.args([target, "--release", "--message-format=json-render-diagnostics"]);
        let program = executable(&child::stdout_of_build(&mut command)?, target)
            .ok_or_else(|| format!("cargo did not say where {name} is"))?;
        copy(&program, &directory.join(name))?;
    }
    for file in FILES {
        copy(&child::root().join(file), &directory.join("files").join(file))?;
    }
    match shared().map(|shared| shared.join(SCENE)).filter(|scene| scene.is_file()) {
        Some(scene) => copy(&scene, &directory.join("scenes").join(scene.file_name().unwrap_or_default()))?,
        None => println!("Without {SCENE}: the collection of real scenes is missing (SHADOWGRAPH_SHARED)."),
    }
    print!("\nBuilt {DIRECTORY}. {NEXT}");
    Ok(())
}

/// Returns the directory of the test material that is not in the repository, as the tests find it.
fn shared() -> Option<PathBuf> {
    let named = std::env::var_os("SHADOWGRAPH_SHARED").map(PathBuf::from);
    named.or_else(|| Some(child::root().parent()?.join("shared")))
}

/// Returns the path of the executable of a target in cargo's messages, which also name programs that its tests run.
fn executable(messages: &str, target: &str) -> Option<PathBuf> {
    let name = format!("\"name\":\"{target}\"");
    let mut messages = messages.lines().filter(|line| line.contains(&name));
    let path = messages.find_map(|line| line.split_once("\"executable\":\"")?.1.split('"').next());
    path.map(PathBuf::from)
}

fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let parent = to.parent().unwrap_or(Path::new("."));
    std::fs::create_dir_all(parent)
        .and_then(|()| std::fs::copy(from, to))
        .map(|_| ())
        .map_err(|error| format!("cannot copy {} to {}: {error}", from.display(), to.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_executable_is_found_in_the_messages_of_cargo() {
        let messages = "{\"target\":{\"name\":\"pixels\"},\"executable\":null}\n\
            {\"target\":{\"name\":\"pixels\"},\"executable\":\"/t/release/pixels-1\",\"fresh\":true}\n\
            {\"target\":{\"name\":\"peers\"},\"executable\":\"/t/release/peers\",\"fresh\":true}\n\
            {\"reason\":\"build-finished\",\"success\":true}\n";
        assert_eq!(executable(messages, "pixels"), Some(PathBuf::from("/t/release/pixels-1")));
        assert_eq!(executable(messages, "none"), None);
    }
}
