//! Checks the layers of the design: which packages may depend on which, which words a crate must not use,
//! that no retired word is left, and that shaders have the constants of Rust.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

mod cycles;
mod imports;
mod retired_words;
mod shader_constants;
mod source;

use serde_json::Value;
use shadowgraph_tests::repository;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

const CORE: &str = "shadowgraph-core";
const INSPECT: &str = "shadowgraph-inspect";
const SHADERS: &str = "shadowgraph-shaders";
const SCENE: &str = "shadowgraph-scene";
const SHADOWS: &str = "shadowgraph-shadows";
const LIGHTING: &str = "shadowgraph-lighting";
const FACADE: &str = "shadowgraph";

const SAMPLES: &str = "shadowgraph-samples";
const QUALITY: &str = "shadowgraph-quality";
const CLI: &str = "shadowgraph-cli";
const WEB: &str = "shadowgraph-web";

/// The members that a member may depend on, dependencies of its tests and build scripts included.
const DEPENDENCIES: [(&str, &[&str]); 16] = [
    (CORE, &[]),
    (INSPECT, &[CORE]),
    (SHADERS, &[]),
    (SCENE, &[CORE, SHADERS]),
    (SAMPLES, &[SCENE]),
    (SHADOWS, &[CORE, SHADERS, SCENE]),
    (LIGHTING, &[CORE, SHADERS, SCENE, SHADOWS]),
    (FACADE, &[CORE, INSPECT, SHADERS, SCENE, SHADOWS, LIGHTING]),
    (QUALITY, &[CORE, INSPECT, SHADERS, SCENE, SHADOWS, LIGHTING, FACADE, SAMPLES]),
    (CLI, &[INSPECT, FACADE, SAMPLES, QUALITY]),
    (WEB, &[FACADE, SAMPLES]),
    ("shadowgraph-examples", &[CORE, INSPECT, SHADERS, SCENE, SHADOWS, LIGHTING, FACADE, SAMPLES]),
    ("shadowgraph-tests", &[CORE, INSPECT, SHADERS, SCENE, SHADOWS, LIGHTING, FACADE, SAMPLES, QUALITY]),
    ("custom_technique", &[FACADE, CLI]),
    ("xtask", &[]),
    ("bundle", &[]),
];

/// Dependencies that only tests and examples of a member may use; none of them depends on the member.
const DEV_DEPENDENCIES: [(&str, &str); 1] = [(FACADE, SAMPLES)];

/// Members that are published, and so may not depend on the others.
const PUBLISHED: [&str; 11] =
    [CORE, INSPECT, SHADERS, SCENE, SAMPLES, SHADOWS, LIGHTING, FACADE, QUALITY, CLI, WEB];

fn packages() -> BTreeMap<String, Value> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments = ["metadata", "--no-deps", "--format-version", "1", "--offline"];
    let output = Command::new(cargo).args(arguments).current_dir(repository()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let metadata: Value = serde_json::from_slice(&output.stdout).unwrap();
    let packages = metadata["packages"].as_array().unwrap().iter();
    packages.map(|package| (package["name"].as_str().unwrap().to_owned(), package.clone())).collect()
}

fn dependencies(package: &Value) -> Vec<String> {
    let of_development = |dependency: &&Value| {
        let names = (package["name"].as_str().unwrap(), dependency["name"].as_str().unwrap());
        dependency["kind"] == "dev" && DEV_DEPENDENCIES.contains(&names)
    };
    let list = package["dependencies"].as_array().unwrap().iter();
    let list = list.filter(|dependency| !of_development(dependency));
    list.map(|dependency| dependency["name"].as_str().unwrap().to_owned()).collect()
}

/// The crates that a member needs with its default features, without those of its tests.
fn crates_below(member: &str) -> Vec<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let arguments =
        ["tree", "--offline", "-e", "normal", "--prefix", "none", "--format", "{p}", "-p", member];
    let output = Command::new(cargo).args(arguments).current_dir(repository()).output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8(output.stdout).unwrap();
    text.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn libraries_depend_on_no_command_line_and_no_window() {
    let program = ["clap", "indicatif", "tempfile", "egui", "winit"];
    for (member, forbidden) in [(FACADE, program.as_slice()), (QUALITY, &["clap", "egui", "winit"])] {
        let below = crates_below(member);
        assert!(below.contains(&"wgpu".to_owned()), "{below:?}");
        let found: Vec<_> = below.iter().filter(|name| forbidden.contains(&name.as_str())).collect();
        assert!(found.is_empty(), "{member} depends on {found:?}");
    }
}

#[test]
fn inspecting_a_plan_needs_no_device_no_command_line_and_no_window() {
    let below = crates_below(INSPECT);
    assert!(below.contains(&CORE.to_owned()), "{below:?}");
    let forbidden = ["wgpu", "clap", "indicatif", "tempfile", "egui", "winit"];
    let found: Vec<_> = below.iter().filter(|name| forbidden.contains(&name.as_str())).collect();
    assert!(found.is_empty(), "{INSPECT} depends on {found:?}");
}

#[test]
fn packages_depend_only_on_the_layers_below_them() {
    let packages = packages();
    let rules: BTreeMap<&str, &[&str]> = DEPENDENCIES.into_iter().collect();
    assert!(packages.keys().map(String::as_str).eq(rules.keys().copied()), "{:?}", packages.keys());
    for (name, package) in &packages {
        for dependency in dependencies(package).iter().filter(|dependency| packages.contains_key(*dependency))
        {
            let allowed = rules[name.as_str()];
            assert!(
                allowed.contains(&dependency.as_str()),
                "{name} must not depend on {dependency}, only on {allowed:?}"
            );
        }
    }
}

#[test]
fn only_the_crates_for_others_are_published() {
    for (name, package) in packages() {
        let never = package["publish"].as_array().is_some_and(Vec::is_empty);
        assert_eq!(!never, PUBLISHED.contains(&name.as_str()), "{name}");
    }
}

#[test]
fn xtask_uses_only_the_standard_library() {
    assert_eq!(dependencies(&packages()["xtask"]), Vec::<String>::new());
}

#[test]
fn the_graph_and_its_compiler_build_without_a_gpu_library() {
    let core = &packages()[CORE];
    let wgpu = core["dependencies"]
        .as_array()
        .unwrap()
        .iter()
        .find(|dependency| dependency["name"] == "wgpu")
        .unwrap();
    assert_eq!(wgpu["optional"], true);
}

#[test]
fn core_mentions_no_light_shadow_mesh_camera_or_window() {
    let words =
        ["light", "shadow", "mesh", "camera", "window", "lights", "shadows", "meshes", "cameras", "windows"];
    forbid_words("crates/core/src", &words);
}

#[test]
fn the_compiler_does_not_touch_wgpu() {
    forbid("crates/core/src/compile", |line| line.contains("wgpu::").then(|| "wgpu::".to_owned()));
}

#[test]
fn only_one_file_of_core_has_shader_text() {
    let is_shader = |path: &PathBuf| {
        let text = std::fs::read_to_string(path).unwrap();
        ["@vertex", "@fragment", "@compute"].iter().any(|stage| text.contains(stage))
    };
    let files: Vec<PathBuf> =
        sources("crates/core/src", &["rs", "wgsl"]).into_iter().filter(is_shader).collect();
    assert_eq!(files, [repository().join("crates/core/src/internal/internal.wgsl")]);
}

#[test]
fn scene_mentions_no_shadow_technique_and_no_lighting_model() {
    let techniques =
        ["pcf", "pcss", "vsm", "evsm", "esm", "msm", "csm", "sdsm", "cascade", "cascades", "cascaded"];
    let models =
        ["ggx", "brdf", "bsdf", "lambert", "lambertian", "phong", "fresnel", "burley", "smith", "tonemap"];
    forbid_words("crates/scene/src", &[techniques.as_slice(), models.as_slice()].concat());
}

#[test]
fn lighting_names_no_technique() {
    let names: Vec<&str> = shadowgraph::shadows::Techniques::built_in()
        .kinds()
        .iter()
        .map(|kind| kind.name)
        // An ordinary English word.
        .filter(|name| *name != "none")
        .collect();
    assert!(names.len() > 5);
    forbid_words("crates/lighting/src", &names);
    for file in ["lighting.wgsl", "forward.wgsl"] {
        let text = std::fs::read_to_string(repository().join("shaders/wgsl").join(file)).unwrap();
        assert_eq!(words(&text).iter().find(|word| names.contains(&word.as_str())), None, "{file}");
    }
}

#[test]
fn shadows_do_not_mention_gltf() {
    forbid("crates/shadows/src", |line| line.to_lowercase().contains("gltf").then(|| "glTF".to_owned()));
}

#[test]
fn no_unfinished_code_is_left_in_the_source() {
    // In two parts, so that this file does not hold them itself.
    let marks = [concat!("todo", "!"), concat!("unimplemented", "!"), concat!("FIX", "ME")];
    for dir in ["crates", "shaders", "examples", "tests", "xtask"] {
        forbid(dir, |line| marks.iter().find(|mark| line.contains(**mark)).map(|mark| (*mark).to_owned()));
    }
}

fn forbid_words(dir: &str, forbidden: &[&str]) {
    // The method of slices is the standard library's word.
    let said = |line: &str| words(&line.replace(".windows(", "("));
    forbid(dir, |line| said(line).into_iter().find(|word| forbidden.contains(&word.as_str())));
}

/// Fails with every line of a directory's sources in which `find` finds something.
fn forbid(dir: &str, find: impl Fn(&str) -> Option<String>) {
    let mut found = Vec::new();
    for path in sources(dir, &["rs", "wgsl"]) {
        let text = std::fs::read_to_string(&path).unwrap();
        for (number, line) in text.lines().enumerate() {
            if let Some(what) = find(line) {
                found.push(format!("{}:{}: `{what}` in: {}", path.display(), number + 1, line.trim()));
            }
        }
    }
    assert!(found.is_empty(), "{dir} must not contain this:\n{}", found.join("\n"));
}

/// Returns every source file under a directory of the repository, in order.
fn sources(dir: &str, ends: &[&str]) -> Vec<PathBuf> {
    fn collect(dir: &Path, ends: &[&str], found: &mut Vec<PathBuf>) {
        for path in std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                collect(&path, ends, found);
            } else if path.extension().is_some_and(|end| ends.iter().any(|wanted| end == *wanted)) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    collect(&repository().join(dir), ends, &mut found);
    assert!(!found.is_empty(), "{dir} has no source");
    found.sort();
    found
}

/// Returns the words of a line in lower case; `shadow_map` and `ShadowMap` are two words each.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before_was_small = false;
    for c in line.chars() {
        let starts = c.is_uppercase() && before_was_small;
        before_was_small = c.is_lowercase();
        if starts || !c.is_alphabetic() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c.is_alphabetic()) {
            word.extend(c.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[test]
fn words_are_found_inside_names_but_not_inside_other_words() {
    assert_eq!(
        words("let shadow_map = ShadowMap2::new();"),
        ["let", "shadow", "map", "shadow", "map", "new"]
    );
    assert_eq!(words("use shadowgraph_core::highlight;"), ["use", "shadowgraph", "core", "highlight"]);
}
