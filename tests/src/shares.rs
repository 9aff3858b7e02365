//! Many random frames, split among processes.

use std::process::Command;
use std::sync::atomic::{AtomicU32, Ordering};

/// Runs a test of this program in a process for each share of the frames, with the number of frames in `SHADOWGRAPH_SOAK` and a seed in
/// `SHADOWGRAPH_SOAK_SEED`; prints the lines with `soak: `. Mesa's software driver frees little of what it allocates for a frame, so
/// one process for all would run out of memory. At most one process per core runs, and at most four: each takes some GiB.
///
/// # Panics
/// If the test fails.
#[allow(clippy::print_stdout, reason = "the person who runs the test reads the lines")]
pub fn in_shares(test: &str, frames: u32, share: u32) {
    let processes = frames.div_ceil(share);
    let next = AtomicU32::new(0);
    let work = || {
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= processes {
                return;
            }
            // The first processes render the remainder.
            in_process(test, seed, frames / processes + u32::from(seed < frames % processes));
        }
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    std::thread::scope(|scope| (0..cores.min(4)).for_each(|_| drop(scope.spawn(work))));
    println!("soak: {frames} frames without an error");
}

#[allow(clippy::print_stdout, clippy::expect_used, reason = "a test")]
fn in_process(test: &str, seed: u32, share: u32) {
    let mut program = Command::new(std::env::current_exe().expect("this program"));
    let variables = [("SHADOWGRAPH_SOAK", share), ("SHADOWGRAPH_SOAK_SEED", seed)];
    program.args([test, "--exact", "--nocapture"]);
    program.envs(variables.map(|(name, number)| (name, number.to_string())));
    let done = program.output().expect("this program again");
    let text = String::from_utf8_lossy(&done.stdout);
    let lines: Vec<_> =
        text.lines().filter_map(|line| line.split_once("soak: ")).map(|(_, lines)| lines).collect();
    println!("soak: seed {seed}: {}", lines.join("; "));
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{variables:?}\n{text}\n{said}");
}
