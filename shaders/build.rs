//! Lists the WGSL files with entry points: all files below `wgsl/` that are not modules.
#![allow(clippy::print_stdout, reason = "instructions to cargo")]

use std::error::Error;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Files that Rust completes before they are composed.
const TEMPLATES: [&str; 1] = ["prefilter.wgsl"];

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=wgsl");
    let root = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?).join("wgsl");
    let mut names = Vec::new();
    collect(&root, "", &mut names)?;
    names.sort();
    let mut list = String::new();
    for name in names.iter().filter(|name| !TEMPLATES.contains(&name.as_str())) {
        if !std::fs::read_to_string(root.join(name))?.contains("#define_import_path") {
            writeln!(list, "    file!({name:?}),")?;
        }
    }
    let target = PathBuf::from(std::env::var("OUT_DIR")?).join("entries.rs");
    std::fs::write(target, format!("pub(crate) const ENTRIES: &[ModuleSource] = &[\n{list}];\n"))?;
    Ok(())
}

/// Adds the names of the WGSL files in a folder, relative to the root, with `/` on every system.
fn collect(folder: &Path, prefix: &str, names: &mut Vec<String>) -> Result<(), Box<dyn Error>> {
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            collect(&entry.path(), &format!("{name}/"), names)?;
        } else if name.ends_with(".wgsl") {
            names.push(name);
        }
    }
    Ok(())
}
