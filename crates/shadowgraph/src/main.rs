//! The `shadowgraph` program: `shadowgraph --help` tells all.

use std::process::ExitCode;

use shadowgraph::shadows::Techniques;

fn main() -> ExitCode {
    shadowgraph::program::run(&Techniques::built_in())
}
