//! The `shadowgraph` program with an additional technique.
//!
//! `cargo run -p custom_technique -- render --technique esm` draws the demo scene with it.

mod esm;

use std::process::ExitCode;

use shadowgraph::Registry;

fn main() -> ExitCode {
    let mut registry = Registry::built_in();
    match registry.techniques.register(esm::ESM) {
        Ok(()) => shadowgraph_cli::run(&registry),
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}
