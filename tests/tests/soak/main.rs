//! Many frames of changing worlds leak no memory. `SHADOWGRAPH_SOAK` is the number of frames, `SHADOWGRAPH_SOAK_SEED` the seed.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod edits;
mod pipelines;

use std::io::Write;
use std::sync::Mutex;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// More than any frame takes, including the creation of pipelines on a busy machine.
const FRAME_LIMIT: Duration = Duration::from_secs(300);

/// Held by each test: they measure the memory of the whole process.
static ALONE: Mutex<()> = Mutex::new(());

/// Returns the memory of this process, MiB; `None` where it cannot be read.
fn memory_mib() -> Option<u64> {
    let pages = std::fs::read_to_string("/proc/self/statm").ok()?;
    Some(pages.split_whitespace().nth(1)?.parse::<u64>().ok()? / 256)
}

/// Returns an integer that the environment may set.
fn from_env(variable: &str, default: u32) -> u32 {
    std::env::var(variable).map_or(default, |number| number.parse().unwrap())
}

/// Ends the process when no message follows the last one in time: a driver that hangs cannot be interrupted.
fn watch(limit: Duration) -> Sender<String> {
    let (sender, doing) = channel::<String>();
    std::thread::spawn(move || {
        let mut now = String::from("the start");
        loop {
            match doing.recv_timeout(limit) {
                Ok(next) => now = next,
                Err(RecvTimeoutError::Disconnected) => return,
                Err(RecvTimeoutError::Timeout) => {
                    // Not `eprintln!`: that would be captured, and end with the process.
                    let _ =
                        writeln!(std::io::stderr(), "soak: not finished after {} s: {now}", limit.as_secs());
                    std::process::exit(1);
                }
            }
        }
    });
    sender
}

/// Returns whether the last quarter's peak is at most a quarter above those of the first half, and `more`.
fn is_flat(peaks: [u64; 4], more: u64) -> bool {
    peaks[3] <= peaks[1].max(peaks[0]) * 5 / 4 + more
}
