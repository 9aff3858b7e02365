//! Finds the Vulkan driver that commands draw with.

use crate::child;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Driver that a command needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Driver {
    /// Any driver.
    Any,
    /// A software driver: the tests' images must be the same on every machine.
    Software,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Missing {
    Loader,
    Driver,
    SoftwareDriver,
}

impl Missing {
    /// Returns what is missing on this machine, if anything.
    pub(crate) fn find(driver: Driver) -> Option<Missing> {
        let names: Vec<String> =
            driver_files().iter().filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect();
        missing(driver, child::has_library("libvulkan.so.1"), &names)
    }

    pub(crate) fn name(self) -> &'static str {
        match self {
            Missing::Loader => "the Vulkan loader (libvulkan.so.1)",
            Missing::Driver => "a Vulkan driver",
            Missing::SoftwareDriver => "a software Vulkan driver",
        }
    }
}

fn missing(driver: Driver, has_loader: bool, driver_names: &[String]) -> Option<Missing> {
    let is_software = |name: &String| name.starts_with("lvp") || name.contains("swiftshader");
    if driver_names.is_empty() {
        Some(Missing::Driver)
    } else if driver == Driver::Software && !driver_names.iter().any(is_software) {
        Some(Missing::SoftwareDriver)
    } else if !has_loader {
        Some(Missing::Loader)
    } else {
        None
    }
}

/// Returns the driver manifests that the Vulkan loader would find.
fn driver_files() -> Vec<PathBuf> {
    // Either variable replaces the search.
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(list) = std::env::var_os(name).filter(|list| !list.is_empty()) {
            return std::env::split_paths(&list).flat_map(|path| manifests(&path)).collect();
        }
    }
    let added = std::env::var_os("VK_ADD_DRIVER_FILES").unwrap_or_default();
    let mut found: Vec<PathBuf> = std::env::split_paths(&added).flat_map(|path| manifests(&path)).collect();
    for base in search_dirs(&|name| std::env::var_os(name)) {
        found.extend(manifests(&base.join("vulkan/icd.d")));
    }
    found
}

/// Returns the loader's search path on Linux, without the `vulkan/icd.d` at the end.
fn search_dirs(variable: &dyn Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    let home = set("HOME").map(PathBuf::from);
    let one = |name: &str, in_home: &str| {
        set(name).map(PathBuf::from).or_else(|| Some(home.as_ref()?.join(in_home)))
    };
    let many = |name: &str, default: &str| {
        let list = set(name).unwrap_or_else(|| default.into());
        std::env::split_paths(&list).collect::<Vec<_>>()
    };
    let mut dirs: Vec<PathBuf> = one("XDG_CONFIG_HOME", ".config").into_iter().collect();
    dirs.extend(many("XDG_CONFIG_DIRS", "/etc/xdg"));
    dirs.extend(["/usr/local/etc".into(), "/etc".into()]);
    dirs.extend(one("XDG_DATA_HOME", ".local/share"));
    dirs.extend(many("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
    dirs.push("/run/opengl-driver/share".into());
    dirs
}

/// Returns the path if it is a manifest, or the manifests in it if it is a directory.
fn manifests(path: &Path) -> Vec<PathBuf> {
    let is_manifest = |path: &Path| path.extension().is_some_and(|end| end == "json") && path.is_file();
    if is_manifest(path) {
        return vec![path.to_path_buf()];
    }
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.filter(|path| is_manifest(path)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn a_machine_without_driver_files_lacks_a_driver() {
        assert_eq!(missing(Driver::Any, true, &[]), Some(Missing::Driver));
    }

    #[test]
    fn a_driver_without_the_loader_is_not_enough() {
        assert_eq!(missing(Driver::Any, false, &names(&["radeon_icd.x86_64.json"])), Some(Missing::Loader));
    }

    #[test]
    fn the_tests_need_a_software_driver_besides_a_hardware_driver() {
        let hardware = names(&["nvidia_icd.json"]);
        assert_eq!(missing(Driver::Any, true, &hardware), None);
        assert_eq!(missing(Driver::Software, true, &hardware), Some(Missing::SoftwareDriver));
        assert_eq!(
            missing(Driver::Software, true, &names(&["nvidia_icd.json", "lvp_icd.x86_64.json"])),
            None
        );
    }

    #[test]
    fn the_search_follows_the_variables_and_falls_back_to_the_home_directory() {
        let dirs = search_dirs(&|name| match name {
            "HOME" => Some("/home/a".into()),
            "XDG_DATA_DIRS" => Some("/one:/two".into()),
            _ => None,
        });
        for expected in ["/home/a/.config", "/home/a/.local/share", "/etc", "/one", "/two"] {
            assert!(dirs.contains(&PathBuf::from(expected)), "{expected} is missing from {dirs:?}");
        }
        assert!(!dirs.contains(&PathBuf::from("/usr/share")));
    }

    #[test]
    fn a_missing_directory_has_no_manifests() {
        assert_eq!(manifests(Path::new("/nowhere/at/all")), Vec::<PathBuf>::new());
    }
}
