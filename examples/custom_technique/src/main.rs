//! The `shadowgraph` program with one technique more.
//!
//! `cargo run -p custom_technique -- render --technique esm` draws the demo scene with it.

mod esm;

use std::process::ExitCode;

use shadowgraph::shadows::Techniques;

fn main() -> ExitCode {
    let mut techniques = Techniques::built_in();
    match techniques.register(esm::ESM) {
        Ok(()) => shadowgraph::program::run(&techniques),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
