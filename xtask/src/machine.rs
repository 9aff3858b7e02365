//! Installs what commands need on the machine: a Vulkan driver, and the programs that some tests start.

use crate::apt::{self, Packages};
use crate::child;
use crate::driver::{Driver, Missing};

/// Requirements of a command on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    /// A Vulkan driver of this kind.
    Driver(Driver),
    /// A software driver, and the programs that tests start; tests skip without these programs.
    Tests,
}

/// A program or library, and the packages that have it.
#[derive(Clone, Copy)]
struct Requirement {
    name: &'static str,
    packages: Packages,
}

const DRIVER: Packages = [
    "mesa-vulkan-drivers libvulkan1",
    "mesa-vulkan-drivers vulkan-loader",
    "vulkan-swrast vulkan-icd-loader",
];

/// Programs of the tests: the names that each may have in `PATH`, and its packages.
const PROGRAMS: [(&[&str], Requirement); 5] = [
    (
        &["xvfb-run"],
        Requirement { name: "Xvfb", packages: ["xvfb", "xorg-x11-server-Xvfb", "xorg-server-xvfb"] },
    ),
    (&["xauth"], Requirement { name: "xauth", packages: ["xauth", "xorg-x11-xauth", "xorg-xauth"] }),
    (&["dot"], Requirement { name: "Graphviz", packages: ["graphviz"; 3] }),
    (
        &["chromium", "chromium-browser", "google-chrome"],
        Requirement { name: "Chromium", packages: ["chromium"; 3] },
    ),
    (&["python3"], Requirement { name: "Python", packages: ["python3", "python3", "python"] }),
];

/// Libraries that a window loads when it opens, and their packages.
const LIBRARIES: [(&str, Packages); 5] = [
    ("libX11.so.6", ["libx11-6", "libX11", "libx11"]),
    ("libX11-xcb.so.1", ["libx11-xcb1", "libX11-xcb", "libx11"]),
    ("libXcursor.so.1", ["libxcursor1", "libXcursor", "libxcursor"]),
    ("libXi.so.6", ["libxi6", "libXi", "libxi"]),
    ("libxkbcommon-x11.so.0", ["libxkbcommon-x11-0", "libxkbcommon-x11", "libxkbcommon-x11"]),
];

/// Makes sure that the machine has what a command needs; installs what is missing if it may.
///
/// # Errors
/// Without the driver: what is missing, and the one line to run.
pub(crate) fn prepare(need: Need) -> Result<(), String> {
    if !cfg!(target_os = "linux") {
        println!("Nothing to install: the graphics driver comes with the system.");
        return Ok(());
    }
    let missing = missing(need);
    if missing.is_empty() {
        println!("Everything needed is installed.");
        return Ok(());
    }
    println!("Missing: {}.", names(&missing));
    let installed = apt::install(&packages(&missing));
    let missing = self::missing(need);
    if missing.is_empty() {
        println!("Installed.");
        return Ok(());
    }
    let line = apt::line_to_run(&packages(&missing));
    if let Some(driver) = missing_driver(need) {
        let reason = installed.err().map(|error| format!(" ({error})")).unwrap_or_default();
        return Err(format!("{} is missing{reason}; to install: {line}", driver.name()));
    }
    println!("Tests that need {} are skipped; to install: {line}", names(&missing));
    Ok(())
}

fn missing_driver(need: Need) -> Option<Missing> {
    Missing::find(match need {
        Need::Driver(driver) => driver,
        Need::Tests => Driver::Software,
    })
}

fn missing(need: Need) -> Vec<Requirement> {
    let driver = missing_driver(need).map(|missing| Requirement { name: missing.name(), packages: DRIVER });
    let mut found: Vec<Requirement> = driver.into_iter().collect();
    if need == Need::Tests {
        let absent = |names: &[&str]| !names.iter().any(|name| child::on_path(name));
        found.extend(PROGRAMS.iter().filter(|(names, _)| absent(names)).map(|(_, requirement)| *requirement));
        let absent = LIBRARIES.iter().filter(|(name, _)| !child::has_library(name));
        found.extend(absent.map(|&(name, packages)| Requirement { name, packages }));
    }
    found
}

fn packages(requirements: &[Requirement]) -> Vec<Packages> {
    requirements.iter().map(|requirement| requirement.packages).collect()
}

fn names(requirements: &[Requirement]) -> String {
    requirements.iter().map(|requirement| requirement.name).collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_requirement_names_a_package_of_each_distribution() {
        let libraries = LIBRARIES.map(|(name, packages)| Requirement { name, packages });
        for requirement in PROGRAMS.iter().map(|(_, requirement)| requirement).chain(&libraries) {
            assert!(requirement.packages.iter().all(|name| !name.is_empty()), "{}", requirement.name);
        }
        assert_eq!(names(&libraries[..2]), "libX11.so.6, libX11-xcb.so.1");
    }
}
