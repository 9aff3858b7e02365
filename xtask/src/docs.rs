//! `cargo xtask docs`: draws the images of the book and builds the book.

use crate::child;
use crate::images;
use crate::machine::{self, Need};
use std::process::ExitCode;

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
    machine::prepare(Need::Tests)?;
    for line in images::draw()? {
        println!("{line}");
    }
    Ok(())
}

fn book() -> Result<(), String> {
    if !child::succeeds("mdbook", &["--version"]) {
        return Err("the images are drawn, but building the book needs mdbook; to install: cargo install mdbook --locked".into());
    }
    let status = child::stream(child::command("mdbook").args(["build", "docs"]))?;
    if !status.success() {
        return Err(format!("mdbook build docs ({status})"));
    }
    println!("The book: out/book/index.html");
    Ok(())
}
