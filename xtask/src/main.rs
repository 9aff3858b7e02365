//! The project's commands: `cargo xtask demo`, `web`, `check` and `test`, and those that are needed less often.
//!
//! This program uses only the standard library, so that it builds within seconds and can prepare a machine for the others.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line tool prints for its user")]

mod apt;
mod check;
mod child;
mod demo;
mod docs;
mod driver;
mod gpu_report;
mod images;
mod machine;
mod members;
mod noise;
mod recipes;
mod report;
mod soak;
mod steps;
mod suite;
mod tally;
mod web;

use std::process::ExitCode;

const HELP: &str = "\
Shadowgraph's commands:

  cargo xtask demo    render the built-in scene and dump its render graph into out/
  cargo xtask web     build the page for browsers into out/web; with --open also serve it on this machine
  cargo xtask check   while you work: format, lints, and the tests without a GPU of the packages that
                      changed and of those that depend on them
  cargo xtask test    what a change must pass: format, lints, documentation, every test

Needed less often:

  cargo xtask docs    draw the images of the documents, and build the book (with mdbook) in out/book
  cargo xtask soak    parse a million broken files, and render 10000 frames of random pipelines, sizes,
                      techniques and lights; for another number of frames: cargo xtask soak 2000
  cargo xtask gpu-report
                      build a directory that measures the GPU of another Linux machine, in out/gpu-report
  cargo xtask noise   write the noise of shaders, crates/lighting/src/blue_noise.bin

On Linux, all but `web`, `check`, `gpu-report` and `noise` first make sure of a Vulkan driver, and `test` of the programs that tests start
(Xvfb, Graphviz, Chromium). What is missing is installed with apt-get if you are root or sudo needs no
password; otherwise the line to run is printed.

The program itself:  cargo run -- help
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] | ["help" | "--help" | "-h"] | [_, "--help" | "-h"] => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        ["demo"] => demo::run(),
        ["web"] => web::run(false),
        ["web", "--open"] => web::run(true),
        ["docs"] => docs::run(),
        ["gpu-report"] => gpu_report::run(),
        ["noise"] => noise::run(),
        ["test"] => suite::run(),
        ["check"] => check::run(),
        ["soak"] => soak::run(soak::FRAMES),
        ["soak", frames] => match frames.parse() {
            Ok(frames @ 1..) => soak::run(frames),
            _ => {
                eprintln!("error: `cargo xtask soak {frames}`: expected a number of frames, at least 1");
                ExitCode::from(2)
            }
        },
        other => {
            eprintln!("error: unknown command `cargo xtask {}`\n", other.join(" "));
            eprint!("{HELP}");
            ExitCode::from(2)
        }
    }
}
