//! The workspace's packages, their dependencies among each other, and which of them a change affects.

use crate::child;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// A package of the workspace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Member {
    pub(crate) name: String,
    /// Its directory, relative to the repository's root.
    pub(crate) dir: PathBuf,
    /// The names of the packages of the workspace that it depends on, for tests and build scripts too.
    dependencies: Vec<String>,
}

/// Reads the packages of the workspace.
///
/// # Errors
/// When cargo cannot list them.
pub(crate) fn read() -> Result<Vec<Member>, String> {
    let arguments =
        ["tree", "--workspace", "--depth", "1", "--prefix", "depth", "--target", "all", "--no-dedupe"];
    let tree = child::stdout_of(&mut child::cargo(&arguments))?;
    let members = parse(&tree, &child::root());
    if members.is_empty() { Err("cargo tree lists no package".to_owned()) } else { Ok(members) }
}

/// Reads lines of `cargo tree`: `0name v1.0.0 (/path)` for a package and `1name v1.0.0 (/path)` for each of its dependencies;
/// dependencies from outside of the repository have no path.
fn parse(tree: &str, root: &Path) -> Vec<Member> {
    let mut members: Vec<Member> = Vec::new();
    for line in tree.lines() {
        let Some((_, path)) = line.split_once(" (") else { continue };
        let Ok(dir) = Path::new(path.trim_end_matches(')')).strip_prefix(root) else { continue };
        let Some(name) = line.get(1..).and_then(|line| line.split(' ').next()) else { continue };
        if line.starts_with('0') {
            members.push(Member { name: name.to_owned(), dir: dir.to_owned(), dependencies: Vec::new() });
        } else if let Some(member) = members.last_mut() {
            member.dependencies.push(name.to_owned());
        }
    }
    members
}

/// Files outside of the packages, and the directory of the package whose tests read them.
const READ_BY: [(&str, &str); 2] = [("docs", "tests"), (".ci", "xtask")];

/// Files that every package is built with.
const SHARED: [&str; 4] = ["Cargo.toml", "Cargo.lock", "rustfmt.toml", ".cargo"];

/// Returns the names of the packages that changed files belong to.
pub(crate) fn changed(members: &[Member], files: &[PathBuf]) -> BTreeSet<String> {
    let mut names = BTreeSet::new();
    for file in files {
        let reader =
            READ_BY.iter().find(|(dir, _)| file.starts_with(dir)).map(|(_, reader)| Path::new(reader));
        let is_page = file.parent() == Some(Path::new("")) && file.extension().is_some_and(|is| is == "md");
        let file = reader.unwrap_or(if is_page { Path::new("tests") } else { file });
        let owner = members
            .iter()
            .filter(|member| file.starts_with(&member.dir))
            .max_by_key(|member| member.dir.components().count());
        if let Some(owner) = owner {
            names.insert(owner.name.clone());
        } else if SHARED.iter().any(|shared| file.starts_with(shared)) {
            names.extend(members.iter().map(|member| member.name.clone()));
        }
    }
    names
}

/// Returns the names of the packages that depend on any of these, directly or not, without these.
pub(crate) fn dependents(members: &[Member], names: &BTreeSet<String>) -> BTreeSet<String> {
    let mut all = names.clone();
    loop {
        let more: Vec<_> = members
            .iter()
            .filter(|member| {
                !all.contains(&member.name) && member.dependencies.iter().any(|name| all.contains(name))
            })
            .map(|member| member.name.clone())
            .collect();
        if more.is_empty() {
            return all.difference(names).cloned().collect();
        }
        all.extend(more);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TREE: &str = "\
0app v0.1.0 (/r/app)
1base v0.1.0 (/r/crates/base)
1serde v1.0.228

0base v0.1.0 (/r/crates/base)
1syn v2.0.1

0checks v0.1.0 (/r/tests)
1app v0.1.0 (/r/app)

0nested v0.1.0 (/r/app/nested)
1derive v0.1.0 (proc-macro) (/elsewhere/derive)
";

    fn names(list: &[&str]) -> BTreeSet<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    fn changed_by(files: &[&str]) -> BTreeSet<String> {
        changed(&parse(TREE, Path::new("/r")), &files.iter().map(PathBuf::from).collect::<Vec<_>>())
    }

    #[test]
    fn members_have_the_dependencies_that_are_in_the_workspace() {
        let members = parse(TREE, Path::new("/r"));
        assert_eq!(members.len(), 4);
        assert_eq!(members[0].dependencies, ["base"]);
        assert_eq!(members[3].dependencies, Vec::<String>::new());
    }

    #[test]
    fn a_file_belongs_to_the_innermost_package_around_it() {
        assert_eq!(changed_by(&["app/src/lib.rs"]), names(&["app"]));
        assert_eq!(changed_by(&["app/nested/src/lib.rs"]), names(&["nested"]));
        assert_eq!(changed_by(&["docs/start.md", "README.md"]), names(&["checks"]));
        assert_eq!(changed_by(&["Cargo.lock"]).len(), 4);
        assert_eq!(changed_by(&["LICENSE-MIT"]), names(&[]));
    }

    #[test]
    fn dependents_are_found_over_several_packages() {
        let members = parse(TREE, Path::new("/r"));
        assert_eq!(dependents(&members, &names(&["base"])), names(&["app", "checks"]));
        assert_eq!(dependents(&members, &names(&["nested"])), names(&[]));
    }
}
