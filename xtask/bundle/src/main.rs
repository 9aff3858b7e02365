//! `bundle INPUT.wasm DIRECTORY`: writes the module of JavaScript, its types and the WebAssembly, and prints the size of the latter in bytes, as
//! it is and compressed as servers compress it. Its own program, because `xtask` uses only the standard library.
#![allow(clippy::print_stdout, reason = "a command-line tool prints for its user")]

use anyhow::{Context, Result, bail};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;
use std::path::Path;
use wasm_bindgen_cli_support::Bindgen;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [input, directory] = arguments.as_slice() else { bail!("usage: bundle INPUT.wasm DIRECTORY") };
    Bindgen::new()
        .input_path(input)
        .web(true)?
        .typescript(true)
        .omit_default_module_path(false)
        .generate(directory)?;
    let stem = Path::new(input).file_stem().with_context(|| format!("{input} has no name"))?;
    let output = Path::new(directory).join(format!("{}_bg.wasm", stem.to_string_lossy()));
    let bytes = std::fs::read(&output).with_context(|| format!("cannot read {}", output.display()))?;
    let mut compressed = GzEncoder::new(Vec::new(), Compression::best());
    compressed.write_all(&bytes)?;
    println!("{} {}", bytes.len(), compressed.finish()?.len());
    Ok(())
}
