//! `cargo xtask soak`: the long forms of two tests. Broken files of every kind are read, and frames are drawn while everything
//! changes.

use crate::child::{self, RuntimeFolder};
use crate::driver::Driver;
use crate::machine::{self, Need};
use std::process::ExitCode;

/// Frames where nobody asks for fewer or more.
pub(crate) const FRAMES: u32 = 10_000;

/// Broken files of each kind for a frame.
const FILES: u32 = 20;

pub(crate) fn run(frames: u32) -> ExitCode {
    match soak(frames) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::from(3)
        }
    }
}

/// Whether both tests passed.
fn soak(frames: u32) -> Result<bool, String> {
    machine::prepare(Need::Driver(Driver::Software))?;
    let runtime = RuntimeFolder::new();
    let files = FILES.saturating_mul(frames);
    let tests: [(&[&str], &str, u32); 2] = [
        (&["--lib", "broken_files"], "SHADOWGRAPH_FUZZ", files),
        (&["--test", "soak"], "SHADOWGRAPH_SOAK", frames),
    ];
    for (test, variable, many) in tests {
        let arguments = [&["test", "--quiet", "--workspace"], test, &["--", "--nocapture"]].concat();
        let mut command = child::cargo(&arguments);
        command.env(variable, many.to_string());
        if !child::stream(runtime.apply(&mut command))?.success() {
            return Ok(false);
        }
    }
    Ok(true)
}
