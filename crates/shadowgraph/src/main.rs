//! The `shadowgraph` program: `shadowgraph --help` tells all.

use std::process::ExitCode;

use shadowgraph::Registry;

fn main() -> ExitCode {
    shadowgraph::program::run(&Registry::built_in())
}
