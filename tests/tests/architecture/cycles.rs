//! Checks which modules of a crate import which.

use crate::imports::{Import, Imports, Module, files};
use crate::{CORE, FACADE, PUBLISHED, SCENE, packages};
use shadowgraph_tests::repository;
use std::path::{Path, PathBuf};

/// Modules of a crate that a module must not import.
const FORBIDDEN: [(&str, &str, &[&str]); 7] = [
    (CORE, "pool", &["execute", "context", "frame", "graph", "compiled", "shader_pass", "builder"]),
    // A frame holds the bodies of its passes, whose arguments are contexts: these know nothing of frames.
    (CORE, "context", &["execute", "frame", "graph", "compiled", "builder"]),
    (CORE, "frame", &["execute", "graph", "compiled", "builder"]),
    (CORE, "compile", &["execute", "pool", "dump"]),
    // A node knows nothing of the pipelines that use it.
    (FACADE, "nodes", &["pipelines"]),
    // The structs of a glTF document know nothing of its validation; nothing that validates loads.
    (SCENE, "gltf::document", &["gltf::validate"]),
    (SCENE, "gltf::validate", &["gltf::load"]),
];

/// All modules that a module near the bottom of a crate may import.
const ONLY: [(&str, &str, &[&str]); 3] = [
    (CORE, "pipeline", &["desc", "device", "error", "internal"]),
    (CORE, "internal", &["desc", "device", "subresource"]),
    (CORE, "history", &["declaration", "desc", "handle"]),
];

/// Returns the folder of a package's sources.
fn sources(package: &str) -> PathBuf {
    let packages = packages();
    let manifest = Path::new(packages[package]["manifest_path"].as_str().unwrap());
    manifest.parent().unwrap().join("src")
}

fn imports(package: &str) -> Imports {
    Imports::new(&files(&sources(package)))
}

fn lines<'i>(package: &str, imports: impl IntoIterator<Item = &'i Import>) -> String {
    let sources = sources(package);
    let folder = sources.strip_prefix(repository()).unwrap_or(&sources).display();
    imports.into_iter().map(|import| format!("\n  {folder}/{import}")).collect()
}

fn names(cycle: &[Module]) -> Vec<String> {
    cycle.iter().map(|module| module.join("::")).collect()
}

/// A rule on a module that does not exist would hold for ever.
fn assert_has(package: &str, imports: &Imports, name: &str) {
    let module: Module = name.split("::").map(str::to_owned).collect();
    assert!(imports.modules.contains(&module), "{package} has no module `{name}`");
}

#[test]
fn modules_do_not_import_the_modules_above_them() {
    for (package, from, forbidden) in FORBIDDEN {
        let imports = imports(package);
        for to in forbidden.iter().copied() {
            assert_has(package, &imports, from);
            assert_has(package, &imports, to);
            let found = lines(package, imports.list.iter().filter(|import| import.is_between(from, to)));
            assert!(found.is_empty(), "{package}: `{from}` must not import `{to}`:{found}");
        }
    }
}

#[test]
fn modules_at_the_bottom_import_only_their_own_list() {
    for (package, from, allowed) in ONLY {
        let imports = imports(package);
        assert_has(package, &imports, from);
        let others = |import: &&Import| {
            let siblings = import.siblings().filter(|(folder, name, _)| folder.is_empty() && *name == from);
            siblings.is_some_and(|(_, _, to)| !allowed.contains(&to))
        };
        let found = lines(package, imports.list.iter().filter(others));
        assert!(found.is_empty(), "{package}: `{from}` may import only {allowed:?}:{found}");
    }
}

#[test]
fn modules_of_a_folder_do_not_import_each_other_in_a_cycle() {
    for package in PUBLISHED {
        let imports = imports(package);
        if let Some((cycle, between)) = imports.cycles().first() {
            panic!(
                "{package}: {:?} import each other:{}",
                names(cycle),
                lines(package, between.iter().copied())
            );
        }
    }
}
