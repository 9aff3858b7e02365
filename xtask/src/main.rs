//! The project's commands: `cargo xtask demo` and `cargo xtask test`, and what is run now and then.
//!
//! Nothing but the standard library, so that it builds at once and can prepare a machine for the rest.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "a command-line tool talks to its user")]

mod apt;
mod child;
mod demo;
mod docs;
mod driver;
mod machine;
mod report;
mod soak;
mod suite;
mod tally;

use std::process::ExitCode;

const HELP: &str = "\
Shadowgraph's commands:

  cargo xtask demo    draw the built-in scene and dump its render graph into out/
  cargo xtask test    format, lints, every test, documentation: what a change must pass

and what is run now and then:

  cargo xtask docs    draw the pictures of the documents anew, and make the book of them (with mdbook) in out/book
  cargo xtask soak    read a million broken files, and draw 10000 frames of ever other pipelines, sizes, techniques and
                      lights; another number: cargo xtask soak 2000

All see to a Vulkan driver first (Linux): a software one is installed when there is none and
apt-get may be used; otherwise the one line to run is printed.

The program itself:  cargo run -- help
";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] | ["help" | "--help" | "-h"] => {
            print!("{HELP}");
            ExitCode::SUCCESS
        }
        ["demo"] => demo::run(),
        ["docs"] => docs::run(),
        ["test"] => suite::run(),
        ["soak"] => soak::run(soak::FRAMES),
        ["soak", frames] => match frames.parse() {
            Ok(frames @ 1..) => soak::run(frames),
            _ => {
                eprintln!("error: `cargo xtask soak {frames}`: give a number of frames, from 1 up");
                ExitCode::from(2)
            }
        },
        other => {
            eprintln!("error: `cargo xtask {}` is not a command\n", other.join(" "));
            eprint!("{HELP}");
            ExitCode::from(2)
        }
    }
}
