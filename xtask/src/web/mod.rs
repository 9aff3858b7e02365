//! `cargo xtask web`: builds the page into `out/web`, and `--open` serves it.

mod serve;
mod toolchain;

pub(crate) use toolchain::prepare as toolchain;

use crate::child;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Where the page is written.
const DIRECTORY: &str = "out/web";
/// The files of the page without its modules.
const PAGE: &str = "crates/web/page";
/// What the WebAssembly may have compressed, bytes.
const MAX_COMPRESSED: u64 = 4 << 20;

/// How a page is built.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Small and fast.
    Release,
    /// Quickly, for tests.
    Test,
}

/// Builds the page; with `open` serves it until the program is ended.
pub(crate) fn run(open: bool) -> ExitCode {
    let built = build(Kind::Release, &child::root().join(DIRECTORY));
    match built.and_then(|()| if open { serve::run(&child::root().join(DIRECTORY)) } else { Ok(()) }) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Builds the page into a directory, and prints its size.
pub(crate) fn build(kind: Kind, directory: &Path) -> Result<(), String> {
    println!("Building the page ...");
    let module = compile(kind)?;
    let failed = |error: std::io::Error| format!("cannot write {}: {error}", directory.display());
    std::fs::create_dir_all(directory).map_err(failed)?;
    let mut bundle = child::cargo(&["run", "--quiet", "--package", "bundle", "--"]);
    let sizes = child::stdout_of_build(bundle.args([&module, directory]))?;
    for entry in std::fs::read_dir(child::root().join(PAGE)).map_err(failed)? {
        let entry = entry.map_err(failed)?;
        std::fs::copy(entry.path(), directory.join(entry.file_name())).map_err(failed)?;
    }
    let sizes: Vec<u64> = sizes.split_whitespace().filter_map(|size| size.parse().ok()).collect();
    let &[bytes, compressed] = sizes.as_slice() else { return Err("the size is not known".into()) };
    let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
    println!(
        "Written: {}, with {:.1} MiB of WebAssembly, {:.1} MiB compressed",
        directory.display(),
        mib(bytes),
        mib(compressed)
    );
    match kind {
        Kind::Release if compressed > MAX_COMPRESSED => {
            Err(format!("that is more than {} MiB compressed", mib(MAX_COMPRESSED)))
        }
        _ => Ok(()),
    }
}

/// Compiles the crate, and returns the path of its WebAssembly.
fn compile(kind: Kind) -> Result<PathBuf, String> {
    let profile = if kind == Kind::Release { "web" } else { "web-test" };
    let mut command =
        child::cargo(&["rustc", "--package", "shadowgraph-web", "--lib", "--crate-type", "cdylib"]);
    command.args([
        "--profile",
        profile,
        "--target",
        toolchain::TARGET,
        "--message-format",
        "json-render-diagnostics",
    ]);
    toolchain()?.apply(&mut command);
    let messages = child::stdout_of_build(&mut command)?;
    // One message of cargo names the file; only it ends like this.
    let mut names = messages.split('"').filter(|text| text.ends_with("shadowgraph_web.wasm"));
    names.next_back().map(PathBuf::from).ok_or_else(|| "the build wrote no WebAssembly".to_owned())
}
