//! Writes a GLB file for each feature of files into a directory: `feature_files DIRECTORY`.
#![allow(clippy::print_stdout, reason = "a program")]

use std::path::PathBuf;
use std::process::ExitCode;

use shadowgraph_tests::features::{FEATURES, PLAIN};

fn main() -> ExitCode {
    let Some(directory) = std::env::args_os().nth(1).map(PathBuf::from) else {
        println!("usage: feature_files DIRECTORY");
        return ExitCode::from(2);
    };
    let written = std::fs::create_dir_all(&directory).and_then(|()| {
        for feature in [PLAIN].iter().chain(&FEATURES) {
            let file = directory.join(format!("{}.glb", feature.name));
            std::fs::write(&file, (feature.file)().glb())?;
            println!("{} ({}): {}", file.display(), feature.extension, feature.drawn);
        }
        Ok(())
    });
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            println!("error: {}: {error}", directory.display());
            ExitCode::FAILURE
        }
    }
}
