//! `cargo xtask soak`: long runs of the tests that check properties of random values, parse broken files of every kind, and render
//! frames of random pipelines.

use crate::child::{self, RuntimeDir};
use crate::driver::Driver;
use crate::machine::{self, Need};
use std::process::ExitCode;

/// The default number of frames.
pub(crate) const FRAMES: u32 = 10_000;

/// The number of cases of each property of random values.
const CASES: u32 = 4_000;

/// The number of broken files of each kind for every frame.
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

/// Returns whether all tests passed.
fn soak(frames: u32) -> Result<bool, String> {
    machine::prepare(Need::Driver(Driver::Software))?;
    let runtime = RuntimeDir::new();
    let files = FILES.saturating_mul(frames);
    let tests: [(&[&str], &str, u32); 4] = [
        (&["--lib"], "PROPTEST_CASES", CASES),
        (&["--test", "damaged_files"], "SHADOWGRAPH_FUZZ", files),
        (&["--test", "moving"], "SHADOWGRAPH_SOAK", frames),
        (&["--test", "soak"], "SHADOWGRAPH_SOAK", frames),
    ];
    for (test, variable, count) in tests {
        let arguments = [&["test", "--quiet", "--workspace"], test, &["--", "--nocapture"]].concat();
        let mut command = child::cargo(&arguments);
        command.env(variable, count.to_string());
        // Some properties reject a third of their random values.
        command.env("PROPTEST_MAX_GLOBAL_REJECTS", (4 * CASES).to_string());
        if !child::stream(runtime.apply(&mut command))?.success() {
            return Ok(false);
        }
    }
    Ok(true)
}
