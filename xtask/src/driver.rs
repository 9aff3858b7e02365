//! A Vulkan driver on the machine: finds one, or installs Mesa's software driver.

use crate::child;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

const PACKAGES: [&str; 2] = ["mesa-vulkan-drivers", "libvulkan1"];

/// What a command needs of the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Need {
    /// Any driver: a picture is wanted.
    Any,
    /// A software driver: the tests' pictures are to be the same everywhere.
    Software,
}

/// Makes sure that there is a driver; installs one if it must and may.
///
/// # Errors
/// What is missing and the one line to run.
pub(crate) fn ensure(need: Need) -> Result<(), String> {
    if !cfg!(target_os = "linux") {
        println!("Nothing to install: the graphics driver comes with the system.");
        return Ok(());
    }
    let missing = match Missing::find(need) {
        None => {
            println!("A Vulkan driver is installed.");
            return Ok(());
        }
        Some(missing) => missing,
    };
    println!("{}.", missing.text());
    let Some(prefix) = right_to_install() else {
        return Err(format!("{}; install one with: {}", missing.text(), line_to_run()));
    };
    install(&prefix)?;
    match Missing::find(need) {
        None => {
            println!("A Vulkan driver is installed now.");
            Ok(())
        }
        Some(missing) => Err(format!("{}, even after: {}", missing.text(), line_to_run())),
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Missing {
    Loader,
    Driver,
    SoftwareDriver,
}

impl Missing {
    fn find(need: Need) -> Option<Missing> {
        let names: Vec<String> =
            driver_files().iter().filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect();
        missing(need, has_loader(), &names)
    }

    fn text(self) -> &'static str {
        match self {
            Missing::Loader => "The Vulkan loader (libvulkan.so.1) is missing",
            Missing::Driver => "No Vulkan driver is installed",
            Missing::SoftwareDriver => "No software Vulkan driver is installed",
        }
    }
}

fn missing(need: Need, has_loader: bool, driver_names: &[String]) -> Option<Missing> {
    let is_software = |name: &String| name.starts_with("lvp") || name.contains("swiftshader");
    if driver_names.is_empty() {
        Some(Missing::Driver)
    } else if need == Need::Software && !driver_names.iter().any(is_software) {
        Some(Missing::SoftwareDriver)
    } else if !has_loader {
        Some(Missing::Loader)
    } else {
        None
    }
}

/// The driver descriptions that the Vulkan loader would find.
fn driver_files() -> Vec<PathBuf> {
    // Either variable replaces the search.
    for name in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        if let Some(list) = std::env::var_os(name).filter(|list| !list.is_empty()) {
            return std::env::split_paths(&list).flat_map(|path| descriptions(&path)).collect();
        }
    }
    let added = std::env::var_os("VK_ADD_DRIVER_FILES").unwrap_or_default();
    let mut found: Vec<PathBuf> =
        std::env::split_paths(&added).flat_map(|path| descriptions(&path)).collect();
    for base in search_folders(&|name| std::env::var_os(name)) {
        found.extend(descriptions(&base.join("vulkan/icd.d")));
    }
    found
}

/// The loader's search path on Linux, without the `vulkan/icd.d` at the end.
fn search_folders(variable: &dyn Fn(&str) -> Option<OsString>) -> Vec<PathBuf> {
    let set = |name: &str| variable(name).filter(|value| !value.is_empty());
    let home = set("HOME").map(PathBuf::from);
    let one = |name: &str, in_home: &str| {
        set(name).map(PathBuf::from).or_else(|| Some(home.as_ref()?.join(in_home)))
    };
    let many = |name: &str, default: &str| {
        let list = set(name).unwrap_or_else(|| default.into());
        std::env::split_paths(&list).collect::<Vec<_>>()
    };
    let mut folders: Vec<PathBuf> = one("XDG_CONFIG_HOME", ".config").into_iter().collect();
    folders.extend(many("XDG_CONFIG_DIRS", "/etc/xdg"));
    folders.extend(["/usr/local/etc".into(), "/etc".into()]);
    folders.extend(one("XDG_DATA_HOME", ".local/share"));
    folders.extend(many("XDG_DATA_DIRS", "/usr/local/share:/usr/share"));
    folders.push("/run/opengl-driver/share".into());
    folders
}

/// A description file, or those of a folder.
fn descriptions(path: &Path) -> Vec<PathBuf> {
    let is_description = |path: &Path| path.extension().is_some_and(|end| end == "json") && path.is_file();
    if is_description(path) {
        return vec![path.to_path_buf()];
    }
    let entries = std::fs::read_dir(path).into_iter().flatten().flatten().map(|entry| entry.path());
    entries.filter(|path| is_description(path)).collect()
}

fn has_loader() -> bool {
    const NAME: &str = "libvulkan.so.1";
    let cached = |ldconfig: &str| child::output_of(ldconfig, &["-p"]).contains(NAME);
    if cached("ldconfig") || cached("/sbin/ldconfig") {
        return true;
    }
    let listed = std::env::var_os("LD_LIBRARY_PATH").unwrap_or_default();
    let mut folders: Vec<PathBuf> = std::env::split_paths(&listed).collect();
    let triplet = format!("{}-linux-gnu", std::env::consts::ARCH);
    for base in ["/lib", "/usr/lib", "/lib64", "/usr/lib64", "/usr/local/lib", "/run/opengl-driver/lib"] {
        folders.extend([PathBuf::from(base), Path::new(base).join(&triplet)]);
    }
    folders.iter().any(|folder| folder.join(NAME).exists())
}

/// The words to put before `apt-get`, or `None` when this process may not install.
fn right_to_install() -> Option<Vec<&'static str>> {
    if !child::succeeds("apt-get", &["--version"]) {
        return None;
    }
    if child::output_of("id", &["-u"]).trim() == "0" {
        return Some(vec!["env"]);
    }
    child::succeeds("sudo", &["-n", "true"]).then(|| vec!["sudo", "-n", "env"])
}

fn install(prefix: &[&str]) -> Result<(), String> {
    println!("Installing Mesa's software driver with apt-get ...");
    // Another package manager at work is waited for.
    const APT: [&str; 4] = ["DEBIAN_FRONTEND=noninteractive", "apt-get", "-qq", "-oDPkg::Lock::Timeout=120"];
    let run = |what: &[&str]| -> Result<bool, String> {
        let words: Vec<&str> = prefix.iter().chain(&APT).chain(what).copied().collect();
        let (program, arguments) = words.split_first().ok_or("nothing to run")?;
        Ok(child::stream(child::command(program).args(arguments))?.success())
    };
    if !run(&["update"])? {
        println!("apt-get update failed; trying with the lists at hand.");
    }
    let mut arguments = vec!["install", "-y", "--no-install-recommends"];
    arguments.extend(PACKAGES);
    if run(&arguments)? { Ok(()) } else { Err(format!("apt-get failed; by hand: {}", line_to_run())) }
}

fn line_to_run() -> String {
    let packages = PACKAGES.join(" ");
    let sudo = if child::output_of("id", &["-u"]).trim() == "0" { "" } else { "sudo " };
    if child::succeeds("apt-get", &["--version"]) {
        format!("{sudo}apt-get update && {sudo}apt-get install -y {packages}")
    } else if child::succeeds("dnf", &["--version"]) {
        format!("{sudo}dnf install -y mesa-vulkan-drivers vulkan-loader")
    } else if child::succeeds("pacman", &["--version"]) {
        format!("{sudo}pacman -S vulkan-swrast vulkan-icd-loader")
    } else {
        "your package manager (Mesa's Vulkan drivers with lavapipe, and the Vulkan loader)".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn a_machine_without_driver_files_lacks_a_driver() {
        assert_eq!(missing(Need::Any, true, &[]), Some(Missing::Driver));
    }

    #[test]
    fn a_driver_without_the_loader_is_not_enough() {
        assert_eq!(missing(Need::Any, false, &names(&["radeon_icd.x86_64.json"])), Some(Missing::Loader));
    }

    #[test]
    fn the_tests_need_a_software_driver_beside_a_hardware_one() {
        let hardware = names(&["nvidia_icd.json"]);
        assert_eq!(missing(Need::Any, true, &hardware), None);
        assert_eq!(missing(Need::Software, true, &hardware), Some(Missing::SoftwareDriver));
        assert_eq!(missing(Need::Software, true, &names(&["nvidia_icd.json", "lvp_icd.x86_64.json"])), None);
    }

    #[test]
    fn the_search_follows_the_variables_and_falls_back_to_the_home_folder() {
        let folders = search_folders(&|name| match name {
            "HOME" => Some("/home/a".into()),
            "XDG_DATA_DIRS" => Some("/one:/two".into()),
            _ => None,
        });
        for expected in ["/home/a/.config", "/home/a/.local/share", "/etc", "/one", "/two"] {
            assert!(folders.contains(&PathBuf::from(expected)), "{expected} is missing from {folders:?}");
        }
        assert!(!folders.contains(&PathBuf::from("/usr/share")));
    }

    #[test]
    fn an_absent_folder_has_no_descriptions() {
        assert_eq!(descriptions(Path::new("/nowhere/at/all")), Vec::<PathBuf>::new());
    }
}
