//! `cargo xtask demo`: renders the built-in scene and dumps its graph as a page, text, JSON and DOT.

use crate::child::{self, RuntimeDir};
use crate::driver::Driver;
use crate::machine::{self, Need};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Arguments of the program, the file that each writes, and what the file shows.
const PRODUCTS: [(&[&str], &str, &str); 5] = [
    (&["render"], "out/demo.png", "the built-in scene"),
    (&["dump", "--format", "html"], "out/demo.html", "its render graph as a page for any browser"),
    (&["dump", "--format", "text"], "out/demo.txt", "the graph as a table, with reasons"),
    (&["dump", "--format", "json"], "out/demo.json", "the graph as data"),
    (&["dump", "--format", "dot"], "out/demo.dot", "the graph for Graphviz"),
];

/// Builds the program without its window. Naming the whole workspace gives dependencies the features that they have in the tests,
/// so that `cargo xtask test` does not build them again.
const BUILD: [&str; 5] = ["build", "--workspace", "--bin", "shadowgraph", "--no-default-features"];

const NEXT: &str = "\
Try next:
  cargo run -- render your.glb --sun \"dir=-1,-2,-1 lux=20000 color=1,0.95,0.9\" -o out/yours.png
  cargo run -- render --aov visibility:0 -o out/sun_visibility.png
  cargo run -- render --aov atlas -o out/atlas.png
  cargo run -- view
";

pub(crate) fn run() -> ExitCode {
    if let Err(error) = machine::prepare(Need::Driver(Driver::Any)) {
        eprintln!("error: {error}");
        return ExitCode::from(3);
    }
    match draw() {
        Ok(()) => ExitCode::SUCCESS,
        Err((code, error)) => {
            eprintln!("error: {error}");
            ExitCode::from(code)
        }
    }
}

fn draw() -> Result<(), (u8, String)> {
    println!("Building the program ...");
    let built = child::stream(&mut child::cargo(&BUILD)).map_err(|error| (1, error))?;
    if !built.success() {
        return Err((1, "the program failed to build".to_owned()));
    }
    let runtime = RuntimeDir::new();
    let program = program().map_err(|error| (1, error))?;
    for (arguments, file, _) in PRODUCTS {
        // A file of an earlier run must not pass for the output of this run.
        let _absent = std::fs::remove_file(child::root().join(file));
        let mut command = child::command(&program);
        command.args(arguments).args(["-o", file]);
        let status = child::stream(runtime.apply(&mut command)).map_err(|error| (1, error))?;
        if !status.success() {
            let code = status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1);
            return Err((code, format!("`shadowgraph {} -o {file}` failed ({status})", arguments.join(" "))));
        }
    }
    list()
}

fn list() -> Result<(), (u8, String)> {
    println!("\nWritten:");
    for (_, file, what) in PRODUCTS {
        let bytes = std::fs::metadata(child::root().join(file)).map_or(0, |data| data.len());
        if bytes == 0 {
            return Err((1, format!("the program succeeded, but {file} is missing or empty")));
        }
        println!("  {file:<14} {:>5} KiB  {what}", bytes.div_ceil(1024));
    }
    print!("\n{NEXT}");
    Ok(())
}

/// Returns the path of the built program: cargo writes it next to this one.
fn program() -> Result<PathBuf, String> {
    let here =
        std::env::current_exe().map_err(|error| format!("cannot find the path of this program: {error}"))?;
    let dir = here.parent().unwrap_or(Path::new("."));
    let program = dir.join(format!("shadowgraph{}", std::env::consts::EXE_SUFFIX));
    if program.is_file() {
        Ok(program)
    } else {
        Err(format!("{} is missing after the build", program.display()))
    }
}
