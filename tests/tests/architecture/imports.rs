//! The imports between the modules of a crate, read from its sources.

use crate::source::{Mention, Source};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::path::Path;

/// The path of a module from the crate's root, which is empty.
pub(crate) type Module = Vec<String>;

/// A path in a source file that names something of another module of the crate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Import {
    /// The source file, relative to the folder of sources.
    file: String,
    line: usize,
    from: Module,
    pub(crate) to: Module,
}

impl Import {
    /// Returns the folder that has both modules, and the two modules in it.
    pub(crate) fn siblings(&self) -> Option<(&[String], &str, &str)> {
        let common = self.from.iter().zip(&self.to).take_while(|(from, to)| from == to).count();
        Some((&self.from[..common], self.from.get(common)?, self.to.get(common)?))
    }

    /// Returns whether the import goes from a module, or one inside it, to another one, or one inside that.
    pub(crate) fn is_between(&self, from: &str, to: &str) -> bool {
        let inside = |module: &[String], path: &str| {
            let path: Vec<&str> = path.split("::").collect();
            module.len() >= path.len() && module.iter().zip(path).all(|(name, part)| name == part)
        };
        inside(&self.from, from) && inside(&self.to, to)
    }
}

impl fmt::Display for Import {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, from, to } = self;
        write!(f, "{file}:{line}: `{}` imports `{}`", from.join("::"), to.join("::"))
    }
}

/// The modules of a crate and the imports between them, without those of its tests.
#[derive(Default)]
pub(crate) struct Imports {
    pub(crate) modules: BTreeSet<Module>,
    pub(crate) list: Vec<Import>,
}

impl Imports {
    /// Reads the source files of a crate: the path of each relative to the folder of sources, and its text.
    pub(crate) fn new(files: &[(String, String)]) -> Self {
        let is_test = |file: &str| file.split('/').any(|part| part == "tests" || part == "tests.rs");
        let mut parsed: Vec<(&str, Module, Source)> = Vec::new();
        for (file, text) in files.iter().filter(|(file, _)| !is_test(file) && file != "main.rs") {
            let mut module: Module = file.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
            module.pop_if(|name| matches!(&**name, "mod" | "lib"));
            parsed.push((file, module, Source::new(text)));
        }
        let test_modules: BTreeSet<Module> = parsed
            .iter()
            .flat_map(|(_, module, source)| source.test_modules.iter().map(|name| child(module, name)))
            .collect();
        parsed.retain(|(_, module, _)| !(0..=module.len()).any(|end| test_modules.contains(&module[..end])));

        let modules: BTreeSet<Module> = parsed.iter().map(|(_, module, _)| module.clone()).collect();
        // What a module imports can be named through it.
        let mut names = BTreeMap::new();
        for (_, module, source) in &parsed {
            for Mention { path, name, .. } in &source.mentions {
                if let (Some(name), Some(path)) = (name, absolute(&modules, module, path)) {
                    names.insert(child(module, name), path);
                }
            }
            names.extend(source.macros.iter().map(|name| (child(&[], name), child(module, name))));
        }
        let mut list = Vec::new();
        for (file, from, source) in &parsed {
            for Mention { line, path, .. } in &source.mentions {
                let Some(path) = absolute(&modules, from, path) else { continue };
                let to = module_of(&modules, &names, path);
                let known = |last: &Import| last.file == *file && last.line == *line && last.to == to;
                if to != *from && !list.last().is_some_and(known) {
                    list.push(Import { file: (*file).to_owned(), line: *line, from: from.clone(), to });
                }
            }
        }
        Self { modules, list }
    }

    /// Returns the sets of sibling modules that import each other in a cycle, with the first import from each to each.
    pub(crate) fn cycles(&self) -> Vec<(Vec<Module>, Vec<&Import>)> {
        let mut next: BTreeMap<Module, BTreeSet<Module>> = BTreeMap::new();
        for (folder, from, to) in self.list.iter().filter_map(Import::siblings) {
            next.entry(child(folder, from)).or_default().insert(child(folder, to));
        }
        let reachable = |start: &Module| {
            let (mut found, mut open) = (BTreeSet::new(), vec![start]);
            while let Some(module) = open.pop() {
                open.extend(next.get(module).into_iter().flatten().filter(|to| found.insert((*to).clone())));
            }
            found
        };
        let reached: BTreeMap<&Module, BTreeSet<Module>> =
            next.keys().map(|module| (module, reachable(module))).collect();
        let cycle = |module: &Module| {
            let reached_back =
                |other: &&Module| reached.get(*other).is_some_and(|back| back.contains(module));
            reached[module].iter().filter(reached_back).cloned().collect::<Vec<Module>>()
        };
        let cycles: BTreeSet<Vec<Module>> =
            next.keys().map(cycle).filter(|cycle| !cycle.is_empty()).collect();
        let imports = |cycle: &[Module]| {
            let mut first = BTreeMap::new();
            for import in &self.list {
                let Some((folder, from, to)) = import.siblings() else { continue };
                if [from, to].into_iter().all(|name| cycle.contains(&child(folder, name))) {
                    first.entry((from, to)).or_insert(import);
                }
            }
            first.into_values().collect()
        };
        cycles.into_iter().map(|cycle| (cycle.clone(), imports(&cycle))).collect()
    }
}

fn child(module: &[String], name: &str) -> Module {
    module.iter().cloned().chain([name.to_owned()]).collect()
}

/// Returns a path from the crate's root; `None` if it begins with a name of another crate or an imported one.
fn absolute(modules: &BTreeSet<Module>, from: &[String], path: &[String]) -> Option<Module> {
    let parents = path.iter().take_while(|part| *part == "super").count();
    let (start, rest) = match &*path[0] {
        "crate" => (&from[..0], &path[1..]),
        "self" => (from, &path[1..]),
        "super" => (&from[..from.len().checked_sub(parents)?], &path[parents..]),
        name if path.len() > 1 && modules.contains(&child(from, name)) => (from, path),
        _ => return None,
    };
    Some([start, rest].concat())
}

/// Returns the module that has what a path from the root names, which `names` may export elsewhere.
fn module_of(modules: &BTreeSet<Module>, names: &BTreeMap<Module, Module>, mut path: Module) -> Module {
    for _ in 0..8 {
        let end = (0..=path.len()).rev().find(|end| modules.contains(&path[..*end])).unwrap_or(0);
        let Some(exported) = path.get(..=end).and_then(|name| names.get(name)) else {
            path.truncate(end);
            break;
        };
        path = [exported, &path[end + 1..]].concat();
    }
    path
}

/// Returns the source files of a folder: the path of each relative to it, and its text.
pub(crate) fn files(sources: &Path) -> Vec<(String, String)> {
    let mut found = Vec::new();
    let mut folders = vec![sources.to_owned()];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|end| end == "rs") {
                let file = path.strip_prefix(sources).unwrap().to_str().unwrap().replace('\\', "/");
                found.push((file, std::fs::read_to_string(&path).unwrap()));
            }
        }
    }
    found.sort();
    found
}

#[test]
fn imports_are_read_from_the_forms_that_name_a_module() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c;\npub use a::{Exported, inner::Deep as Renamed};"),
        (
            "a/mod.rs",
            "pub mod inner;\nmacro_rules! rule { () => { $crate::c::x() } }\nuse crate::b::{self, One, Two};",
        ),
        ("a/inner.rs", "use super::super::c::*;\nfn f() { super::g() }"),
        (
            "b.rs",
            "use crate::Exported;\nuse crate::{\n    Renamed,\n    c::Three,\n};\n\
             // crate::c\n/* crate::c */ const S: (&str, &str, char) = (\"crate::c \\\" crate::c\", r#\"crate::c\"#, '\"');\n\
             fn f<'a>(x: &'a str) -> (crate::c::Four, impl A + use<'a>) { crate::rule!() }\nuse std::crate_name::c;",
        ),
        (
            "c.rs",
            "#[cfg(test)]\nuse crate::a::Exported;\n#[cfg(test)]\nmod probe;\nfn f() {}\n\
             #[cfg(test)]\n#[allow(x)]\nmod tests {\n    use crate::a;\n}",
        ),
        ("c/probe.rs", "use crate::a::Exported;"),
        ("c/tests.rs", "use crate::a::Exported;"),
        ("c/tests/more.rs", "use crate::a::Exported;"),
    ];
    let imports = Imports::new(&files.map(|(file, text)| (file.to_owned(), text.to_owned())));
    let inside = |import: &&Import| import.file != "lib.rs";
    let list: Vec<String> = imports.list.iter().filter(inside).map(Import::to_string).collect();
    assert_eq!(
        list,
        [
            "a/mod.rs:3: `a` imports `b`",
            "a/inner.rs:1: `a::inner` imports `c`",
            "a/inner.rs:2: `a::inner` imports `a`",
            "b.rs:1: `b` imports `a`",
            "b.rs:3: `b` imports `a::inner`",
            "b.rs:4: `b` imports `c`",
            "b.rs:8: `b` imports `c`",
            "b.rs:8: `b` imports `a`",
        ]
    );
    let cycles = imports.cycles();
    let lines = |between: &[&Import]| between.iter().map(ToString::to_string).collect::<Vec<_>>();
    let cycles: Vec<_> = cycles.iter().map(|(cycle, between)| (cycle.concat(), lines(between))).collect();
    assert_eq!(
        cycles,
        [(
            vec!["a".to_owned(), "b".to_owned()],
            vec!["a/mod.rs:3: `a` imports `b`".to_owned(), "b.rs:1: `b` imports `a`".to_owned()]
        )]
    );
}
