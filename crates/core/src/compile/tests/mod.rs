#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod compose;
mod contents;
mod counts;
mod errors;
mod faults;
mod frame_check;
mod frames;
mod graph;
mod helpers;
mod memory;
mod merging;
mod oracle;
mod order;
mod plans;
mod random;
mod regions;
mod sharing;

/// Bytes that look random, always the same ones for a seed.
fn random_bytes(seed: u64, count: usize) -> Vec<u8> {
    let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 32) as u8
    };
    (0..count + 16).map(|_| next()).skip(16).collect()
}

/// Prints a line in spite of the capture of the test harness, to show what was tested.
fn print(line: &str) {
    use std::io::Write as _;
    let _closed = writeln!(std::io::stderr(), "{line}");
}
