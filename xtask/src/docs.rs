//! `cargo xtask docs`: renders the images of the book and builds the book.

use crate::child::{self, RuntimeDir};
use crate::driver::Driver;
use crate::machine::{self, Need};
use std::process::ExitCode;

/// Images in `docs/images/` that the program renders: the name of each file, and the options of `render`.
const RENDERED: [(&str, &[&str]); 14] = [
    ("demo", &["--size", "960x540"]),
    ("nodes/geometry", &["--aov", "depth"]),
    ("nodes/surfaces", &["--aov", "normal"]),
    ("nodes/shadows", &["--aov", "visibility:0"]),
    ("nodes/forward", &[]),
    ("nodes/gbuffer", &["--pipeline", "deferred", "--aov", "base color"]),
    ("nodes/deferred", &["--pipeline", "deferred"]),
    ("nodes/ssao", &["--pipeline", EVERYTHING, "--set", "ssao=true", "--aov", "occlusion"]),
    ("nodes/sky", &["--pipeline", EVERYTHING, "--set", "sky=true"]),
    ("nodes/fog", &["--pipeline", EVERYTHING, "--set", "sky=true", "--set", "fog=true"]),
    ("nodes/hi_z", &["--pipeline", EVERYTHING, "--set", "hi_z=true", "--aov", "depth pyramid"]),
    ("nodes/bloom", &["--pipeline", EVERYTHING, "--set", "bloom=true", "--set", "glow=0.25"]),
    ("nodes/fxaa", &["--pipeline", EVERYTHING, "--set", "fxaa=true"]),
    ("nodes/shadow_debug", &["--pipeline", "debug_cascades"]),
];

/// A pipeline in which every node can be enabled.
const EVERYTHING: &str = "docs/everything.ron";

/// Examples that write images, and the frame that is shown of those that write many.
const EXAMPLES: [(&str, &str); 10] = [
    ("minimal_graph", ""),
    ("post_chain", ""),
    ("compute_only", ""),
    ("temporal", ""),
    ("split_screen", ""),
    ("many_lights", ""),
    ("day_cycle", "/20"),
    ("custom_pipeline", ""),
    ("custom_engine", ""),
    ("stained_glass", ""),
];

pub(crate) fn run() -> ExitCode {
    match draw().and_then(|()| book()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn draw() -> Result<(), String> {
    machine::prepare(Need::Driver(Driver::Any))?;
    let runtime = RuntimeDir::new();
    let cargo = |arguments: &[&str]| {
        println!("cargo {}", arguments.join(" "));
        let status = child::stream(runtime.apply(&mut child::cargo(arguments)))?;
        if status.success() { Ok(()) } else { Err(format!("cargo {} ({status})", arguments.join(" "))) }
    };
    for (name, options) in RENDERED {
        let file = format!("docs/images/{name}.png");
        let mut arguments = vec!["run", "--quiet", "--", "render", "-o", &file];
        if name.starts_with("nodes/") {
            arguments.extend(["--size", "480x270"]);
        }
        arguments.extend(options);
        cargo(&arguments)?;
    }
    for (name, frame) in EXAMPLES {
        cargo(&["run", "--quiet", "--package", "shadowgraph-examples", "--example", name])?;
        let root = child::root();
        let (from, to) = (format!("out/{name}{frame}.png"), format!("docs/images/examples/{name}.png"));
        let dir = root.join("docs/images/examples");
        std::fs::create_dir_all(&dir)
            .and_then(|()| std::fs::copy(root.join(&from), root.join(&to)))
            .map_err(|error| format!("cannot copy {from} to {to}: {error}"))?;
    }
    Ok(())
}

fn book() -> Result<(), String> {
    if !child::succeeds("mdbook", &["--version"]) {
        return Err("the images are rendered, but building the book needs mdbook; to install: cargo install mdbook --locked".into());
    }
    let status = child::stream(child::command("mdbook").args(["build", "docs"]))?;
    if !status.success() {
        return Err(format!("mdbook build docs ({status})"));
    }
    println!("The book: out/book/index.html");
    Ok(())
}
