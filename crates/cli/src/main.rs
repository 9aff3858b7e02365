//! The `shadowgraph` program; see `shadowgraph --help`.

use std::process::ExitCode;

use shadowgraph::Registry;

fn main() -> ExitCode {
    shadowgraph_cli::run(&Registry::built_in())
}
