//! Finds the modules that a file imports, and the order in which they must be added.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use naga_oil::compose::{
    comment_strip_iter::CommentReplaceExt, get_preprocessor_data, parse_imports::parse_imports,
};
use strsim::levenshtein;

use crate::error::Error;
use crate::source::{MODULES, ModuleSource, TECHNIQUE, TECHNIQUES, names};

/// The modules that can be imported, by import path.
pub(crate) struct Library<'a>(BTreeMap<String, &'a ModuleSource>);

/// An import path in a file, of a module or of an item in one.
struct Import {
    path: String,
    line: usize,
}

impl<'a> Library<'a> {
    /// Creates the library of the built-in modules and `extra`, which can replace built-in ones.
    pub(crate) fn new(extra: &'a [ModuleSource]) -> Result<Self, Error> {
        let mut modules: BTreeMap<String, &ModuleSource> = BTreeMap::new();
        for (path, module) in built_in()? {
            modules.insert(path.clone(), module);
        }
        let mut passed: BTreeMap<String, &ModuleSource> = BTreeMap::new();
        for module in extra {
            let path = import_path(module)?;
            if let Some(first) = passed.insert(path.clone(), module) {
                let (first, second) = (first.file.to_string(), module.file.to_string());
                return Err(Error::DuplicateModule { path, first, second });
            }
            modules.insert(path, module);
        }
        Ok(Self(modules))
    }

    /// Returns the module of this import path.
    pub(crate) fn get(&self, path: &str) -> Option<&ModuleSource> {
        self.0.get(path).copied()
    }

    /// Returns the module of this file name.
    pub(crate) fn by_file(&self, file: &str) -> Option<&ModuleSource> {
        self.0.values().copied().find(|module| module.file == file)
    }

    /// Returns the import paths of all modules that `entry` needs, each after its own imports.
    pub(crate) fn needed_by(&self, entry: &ModuleSource) -> Result<Vec<String>, Error> {
        let mut done = Vec::new();
        for path in self.imported_by(entry)? {
            self.visit(path, &mut Vec::new(), &mut done)?;
        }
        Ok(done)
    }

    fn visit(&self, path: String, open: &mut Vec<String>, done: &mut Vec<String>) -> Result<(), Error> {
        if done.contains(&path) {
            return Ok(());
        }
        if let Some(start) = open.iter().position(|other| *other == path) {
            let cycle_paths = open[start..].iter().chain([&path]).filter_map(|path| self.get(path));
            let cycle = cycle_paths.map(|module| module.file.as_ref()).collect::<Vec<_>>().join(" -> ");
            return Err(Error::ImportCycle { cycle });
        }
        let Some(module) = self.get(&path) else { return Ok(()) };
        open.push(path.clone());
        for import in self.imported_by(module)? {
            self.visit(import, open, done)?;
        }
        open.pop();
        done.push(path);
        Ok(())
    }

    /// Returns the import paths of the modules that a file imports.
    fn imported_by(&self, file: &ModuleSource) -> Result<Vec<String>, Error> {
        let mut modules = Vec::new();
        for import in imports(file)? {
            let module = self.module_of(&import.path).ok_or_else(|| self.unknown(file, import))?;
            if !modules.contains(&module) {
                modules.push(module);
            }
        }
        Ok(modules)
    }

    /// Returns the module of an import path: the path itself or, for an item, its parent.
    fn module_of(&self, path: &str) -> Option<String> {
        let parent = path.rsplit_once("::").map(|(parent, _)| parent);
        [Some(path), parent].into_iter().flatten().find(|path| self.0.contains_key(*path)).map(str::to_owned)
    }

    fn unknown(&self, file: &ModuleSource, import: Import) -> Error {
        let Import { path, line } = import;
        let file = file.file.to_string();
        if path == TECHNIQUE || path.rsplit_once("::").is_some_and(|(parent, _)| parent == TECHNIQUE) {
            return Error::NoTechnique { file, line, known: names(TECHNIQUES) };
        }
        let mut similar: Vec<&str> = self.0.keys().map(String::as_str).collect();
        // The name of an item must not count as a difference from its module.
        let parent = path.rsplit_once("::").map_or(path.as_str(), |(parent, _)| parent);
        similar.sort_by_key(|known| levenshtein(known, &path).min(levenshtein(known, parent)));
        similar.truncate(3);
        Error::UnknownImport { similar: similar.join(", "), file, line, path }
    }
}

/// Returns the built-in modules with their import paths.
fn built_in() -> Result<&'static [(String, &'static ModuleSource)], Error> {
    static BUILT_IN: OnceLock<Vec<(String, &ModuleSource)>> = OnceLock::new();
    if let Some(modules) = BUILT_IN.get() {
        return Ok(modules);
    }
    let modules =
        MODULES.iter().map(|module| Ok((import_path(module)?, module))).collect::<Result<_, Error>>()?;
    Ok(BUILT_IN.get_or_init(|| modules))
}

/// Returns the path of the line `#define_import_path`.
pub(crate) fn import_path(module: &ModuleSource) -> Result<String, Error> {
    let path = get_preprocessor_data(&module.source).0;
    // Invalid source is reported later; here only the path matters.
    let path = path.or_else(|| {
        let line = module.source.lines().find_map(|line| line.trim().strip_prefix("#define_import_path"))?;
        line.split_whitespace().next().map(str::to_owned)
    });
    path.ok_or_else(|| Error::NoImportPath { file: module.file.to_string() })
}

/// Returns the imports of a file: its `#import` lines, and paths written inline.
fn imports(file: &ModuleSource) -> Result<Vec<Import>, Error> {
    let mut found = Vec::new();
    for (line, statement) in import_statements(&file.source) {
        let mut declared = Default::default();
        parse_imports(&statement, &mut declared).map_err(|(message, _)| Error::Wgsl {
            file: file.file.to_string(),
            line,
            message: message.to_owned(),
            text: statement.lines().next().unwrap_or_default().trim().to_owned(),
        })?;
        let paths = declared.into_values().flatten();
        found.extend(paths.map(|path| Import { path, line }));
    }
    let (_, used, _) = get_preprocessor_data(&file.source);
    for path in used.into_iter().map(|used| used.import) {
        let line = file.source.lines().position(|line| line.contains(&path)).map_or(1, |index| index + 1);
        found.push(Import { path, line });
    }
    Ok(found)
}

/// Returns the `#import` statements without comments, each with its first line.
fn import_statements(source: &str) -> Vec<(usize, String)> {
    let mut statements: Vec<(usize, String)> = Vec::new();
    let mut braces = 0;
    let mut lines = source.lines();
    for (index, line) in lines.replace_comments().enumerate() {
        let starts =
            line.trim_start().strip_prefix('#').is_some_and(|l| l.trim_start().starts_with("import"));
        if starts {
            statements.push((index + 1, String::new()));
        } else if braces == 0 {
            continue;
        }
        if let Some((_, statement)) = statements.last_mut() {
            statement.push_str(&line);
            statement.push('\n');
            braces = open_braces(statement);
        }
    }
    statements
}

fn open_braces(text: &str) -> usize {
    text.matches('{').count().saturating_sub(text.matches('}').count())
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;

    #[test]
    fn import_statements_are_found_over_several_lines_and_not_in_comments() {
        let source = "// #import not::this\n#import a::b\n#import c::{\n  d, // e\n  f,\n}\nfn g() {}\n";
        let file = ModuleSource::new("x.wgsl", source);
        let found: Vec<_> = imports(&file).unwrap().into_iter().map(|i| (i.path, i.line)).collect();
        let expected = [("a::b", 2), ("c::d", 3), ("c::f", 3)];
        assert_eq!(found, expected.map(|(path, line)| (path.to_owned(), line)));
    }
}
