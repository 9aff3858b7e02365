//! Installs packages with apt-get where this process may, and names the line to run where it may not.

use crate::child;
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
