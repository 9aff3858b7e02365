//! Writes a GLB file with many copies of a box: `cargo run --release -p shadowgraph-tests --bin copies_file -- COUNT FILE`.
#![allow(clippy::print_stderr, reason = "a command-line tool prints for its user")]

use std::process::ExitCode;

use shadowgraph_tests::copies::copies;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [count, file] = &arguments[..] else {
        eprintln!("error: expected COUNT FILE");
        return ExitCode::FAILURE;
    };
    let Some(count) = count.parse().ok().filter(|count| (1..=10_000_000).contains(count)) else {
        eprintln!("error: COUNT: expected a number from 1 to 10000000, got `{count}`");
        return ExitCode::FAILURE;
    };
    if let Err(error) = std::fs::write(file, copies(count).glb()) {
        eprintln!("error: {file}: {error}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
