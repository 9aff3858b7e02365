//! The standard library of `wasm32-unknown-unknown`: from rustup where it has it, else from the source that Debian packages.

use crate::{apt, child};
use std::path::{Path, PathBuf};
use std::process::Command;

pub(crate) const TARGET: &str = "wasm32-unknown-unknown";

/// The packages of Debian with a compiler for the target and the source of its standard library.
const PACKAGES: [&str; 2] = ["rustc-web", "rust-web-src"];
/// How the names of those begin that the compiler loads.
const FAMILIES: [&str; 4] = ["rustc-web", "rust-web-src", "libstd-rust-web", "libllvm"];
/// The compiler in the directory where they are unpacked.
const COMPILER: &str = "usr/bin/rustc";
/// The line that installs the target.
const RUSTUP: [&str; 3] = ["target", "add", TARGET];

/// What a build for the target needs.
pub(crate) enum Toolchain {
    /// The compiler of this project has the target.
    Installed,
    /// The compiler and the source of packages, unpacked in this directory.
    Unpacked(PathBuf),
}

/// Makes sure that crates can be built for the target.
///
/// # Errors
/// The one line to run.
pub(crate) fn prepare() -> Result<Toolchain, String> {
    if is_installed() {
        return Ok(Toolchain::Installed);
    }
    println!("Installing the target {TARGET} ...");
    if child::on_path("rustup")
        && child::stream(child::command("rustup").args(RUSTUP)).is_ok_and(|status| status.success())
        && is_installed()
    {
        return Ok(Toolchain::Installed);
    }
    let directory = child::root().join("target/rust-web");
    if !directory.join(COMPILER).is_file() {
        println!("rustup does not have it; unpacking {} of Debian ...", PACKAGES.join(" and "));
        apt::unpack(&PACKAGES, &FAMILIES, &directory).map_err(|error| {
            format!("{error}; to install the target {TARGET}: rustup {}", RUSTUP.join(" "))
        })?;
    }
    Ok(Toolchain::Unpacked(directory))
}

fn is_installed() -> bool {
    let libraries = child::output_of("rustc", &["--print", "target-libdir", "--target", TARGET]);
    !libraries.trim().is_empty() && Path::new(libraries.trim()).is_dir()
}

impl Toolchain {
    /// Lets a cargo command use the toolchain.
    pub(crate) fn apply(&self, command: &mut Command) {
        let Self::Unpacked(directory) = self else { return };
        let libraries = directory.join(format!("usr/lib/{}-linux-gnu", std::env::consts::ARCH));
        // Of the compiler that this project uses otherwise.
        let sysroot = PathBuf::from(child::output_of("rustc", &["--print", "sysroot"]).trim());
        let linker = format!("lib/rustlib/{}-unknown-linux-gnu/bin/rust-lld", std::env::consts::ARCH);
        command
            .arg("-Zbuild-std=std,panic_abort")
            .env("RUSTC_BOOTSTRAP", "1")
            .env("RUSTC", directory.join(COMPILER))
            .env("LD_LIBRARY_PATH", libraries)
            .env("CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER", sysroot.join(linker));
    }
}
