//! Installs packages with apt-get where this process may, and names the line to run where it may not.

use crate::child;
use std::path::Path;
use std::process::Stdio;

/// The packages that have a program or library, separated by spaces: of Debian, Fedora and Arch Linux.
pub(crate) type Packages = [&'static str; 3];

/// Options of apt-get. It waits for another package manager that is at work.
const APT: [&str; 4] = ["DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq", "-oDPkg::Lock::Timeout=120"];

/// Installs all packages in one call.
///
/// # Errors
/// When this process may not install, or apt-get failed.
pub(crate) fn install(missing: &[Packages]) -> Result<(), String> {
    let prefix = prefix().ok_or("no right to install")?;
    let run = |arguments: &[&str]| -> Result<bool, String> {
        let (program, before) = prefix.split_first().ok_or("nothing to run")?;
        let mut command = child::command(program);
        // Hundreds of lines about unpacking; errors go to the other stream.
        command.args(before).args(APT).args(arguments).stdout(Stdio::null());
        Ok(child::stream(&mut command)?.success())
    };
    println!("Running apt-get update ...");
    if !run(&["update"])? {
        println!("apt-get update failed; using the package lists as they are.");
    }
    // A package that this distribution lacks must not keep the others from being installed.
    let is_known = |package: &&str| child::succeeds("apt-cache", &["show", package]);
    let known: Vec<&str> = packages(missing, 0).into_iter().filter(is_known).collect();
    println!("Installing {} ...", known.join(" "));
    let arguments = [&["install", "-y", "--no-install-recommends"], known.as_slice()].concat();
    if run(&arguments)? { Ok(()) } else { Err("apt-get failed".to_owned()) }
}

/// Downloads packages of Debian with those that they depend on, as far as their names begin like one of `families`, and unpacks them in a
/// directory, where they do not conflict with installed ones. This needs no right to install.
///
/// # Errors
/// When apt does not know a package, or cannot download it.
pub(crate) fn unpack(packages: &[&str], families: &[&str], directory: &Path) -> Result<(), String> {
    const ONLY_NEEDED: [&str; 7] = [
        "--recurse",
        "--no-recommends",
        "--no-suggests",
        "--no-conflicts",
        "--no-breaks",
        "--no-replaces",
        "--no-enhances",
    ];
    if !child::succeeds("apt-cache", &[&["show"], packages].concat()) {
        // A fresh machine has no package lists.
        if let Some(prefix) = prefix() {
            let (program, before) = prefix.split_first().ok_or("nothing to run")?;
            child::stream(child::command(program).args(before).args(APT).arg("update"))?;
        }
    }
    let all = child::output_of("apt-cache", &[&["depends"], &ONLY_NEEDED[..], packages].concat());
    let mut names: Vec<&str> =
        all.lines().filter(|name| families.iter().any(|family| name.starts_with(family))).collect();
    names.sort_unstable();
    names.dedup();
    if let Some(missing) = packages.iter().find(|package| !names.contains(package)) {
        return Err(format!("apt does not know the package {missing}"));
    }
    let archives = directory.join("archives");
    let failed = |error: std::io::Error| format!("cannot write {}: {error}", directory.display());
    std::fs::create_dir_all(&archives).map_err(failed)?;
    let mut download = child::command("apt-get");
    download.args(["-qq", "-oAPT::Sandbox::User=root", "download"]).args(&names).current_dir(&archives);
    if !child::stream(&mut download)?.success() {
        return Err(format!("apt-get cannot download {}", names.join(", ")));
    }
    for archive in std::fs::read_dir(&archives).map_err(failed)? {
        let archive = archive.map_err(failed)?.path();
        let mut unpack = child::command("dpkg-deb");
        if !child::stream(unpack.arg("-x").arg(&archive).arg(directory))?.success() {
            return Err(format!("dpkg-deb cannot unpack {}", archive.display()));
        }
    }
    std::fs::remove_dir_all(&archives).map_err(failed)
}

/// Returns the line with which a person installs the packages.
pub(crate) fn line_to_run(missing: &[Packages]) -> String {
    let sudo = if is_root() { "" } else { "sudo " };
    let packages = |distribution| packages(missing, distribution).join(" ");
    if child::succeeds("apt-get", &["--version"]) {
        format!("{sudo}apt-get update && {sudo}apt-get install -y {}", packages(0))
    } else if child::succeeds("dnf", &["--version"]) {
        format!("{sudo}dnf install -y {}", packages(1))
    } else if child::succeeds("pacman", &["--version"]) {
        format!("{sudo}pacman -S {}", packages(2))
    } else {
        format!("what Debian calls {}", packages(0))
    }
}

/// Returns the names of the packages, each once.
fn packages(missing: &[Packages], distribution: usize) -> Vec<&'static str> {
    let mut names: Vec<&str> = Vec::new();
    for name in missing.iter().flat_map(|packages| packages[distribution].split(' ')) {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

/// Returns the command that runs another one with the right to install; `None` without that right.
fn prefix() -> Option<Vec<&'static str>> {
    if !child::succeeds("apt-get", &["--version"]) {
        return None;
    }
    if is_root() {
        return Some(vec!["env"]);
    }
    child::succeeds("sudo", &["-n", "true"]).then(|| vec!["sudo", "-n", "env"])
}

fn is_root() -> bool {
    child::output_of("id", &["-u"]).trim() == "0"
}
