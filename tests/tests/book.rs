//! The book: every page is in it, no link is dead, and it builds.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use shadowgraph_tests::{on_path, repository, skip};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

fn pages() -> Vec<PathBuf> {
    let files = std::fs::read_dir(repository().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<_> = files.filter(|path| path.extension().is_some_and(|is| is == "md")).collect();
    pages.sort();
    pages
}

/// The text of a page without its code.
fn prose(page: &Path) -> String {
    let text = std::fs::read_to_string(page).unwrap();
    let mut inside = false;
    let lines = text.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        inside ^= fence;
        !inside && !fence
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// What a text links to.
fn links(text: &str) -> Vec<&str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

/// The anchors of a page's headings.
fn anchors(page: &Path) -> BTreeSet<String> {
    let text = prose(page);
    let headings =
        text.lines().filter(|line| line.starts_with('#')).map(|line| line.trim_start_matches('#').trim());
    let kept = |c: char| match c {
        ' ' => Some('-'),
        c if c.is_alphanumeric() || matches!(c, '-' | '_') => Some(c.to_ascii_lowercase()),
        _ => None,
    };
    headings.map(|heading| heading.chars().filter_map(kept).collect()).collect()
}

#[test]
fn every_page_is_in_the_summary() {
    let summary = std::fs::read_to_string(repository().join("docs/SUMMARY.md")).unwrap();
    let mut listed = links(&summary);
    listed.push("SUMMARY.md");
    listed.sort_unstable();
    let names: Vec<_> =
        pages().iter().map(|page| page.file_name().unwrap().to_string_lossy().into_owned()).collect();
    let mut names: Vec<&str> = names.iter().map(String::as_str).collect();
    names.sort_unstable();
    assert_eq!(listed, names);
}

#[test]
fn no_link_of_the_documents_is_dead() {
    let root = repository();
    let outside =
        ["README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md"].map(|file| root.join(file));
    let mut dead = Vec::new();
    let mut count = 0;
    for page in pages().iter().chain(&outside) {
        let text = prose(page);
        for link in links(&text).into_iter().filter(|link| !link.starts_with("https://")) {
            count += 1;
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { page.parent().unwrap().join(file) };
            let there = target.exists() && (anchor.is_empty() || anchors(&target).contains(anchor));
            let in_book = !page.starts_with(root.join("docs")) || !file.starts_with("..");
            if !there || !in_book {
                dead.push(format!("{}: {link}", page.display()));
            }
        }
    }
    assert!(count > 100, "{count}");
    assert!(dead.is_empty(), "{}", dead.join("\n"));
}

#[test]
fn every_picture_of_the_documents_is_used() {
    let texts: String = pages().iter().map(|page| prose(page)).collect();
    let mut folders = vec![repository().join("docs/images")];
    while let Some(folder) = folders.pop() {
        for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(repository().join("docs")).unwrap().to_string_lossy().into_owned();
            assert!(texts.contains(&format!("]({name})")), "{name} is in no page");
        }
    }
}

#[test]
fn the_book_builds() {
    if !on_path("mdbook") {
        return skip("book", "mdbook is not installed");
    }
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new("mdbook");
    let output =
        command.arg("build").arg(repository().join("docs")).arg("-d").arg(folder.path()).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && !said.contains("WARN") && !said.contains("ERROR"), "{said}");
    for page in ["index.html", "errors.html", "design.html"] {
        assert!(folder.path().join(page).is_file(), "{page} is missing");
    }
}

#[test]
fn every_kind_of_node_and_every_example_has_its_place() {
    let page = |name: &str| std::fs::read_to_string(repository().join("docs").join(name)).unwrap();
    let (nodes, examples) = (page("nodes.md"), page("examples.md"));
    for kind in shadowgraph::Registry::built_in().nodes.kinds() {
        assert!(nodes.contains(&format!("**`{}`**", kind.name)), "{} is not in nodes.md", kind.name);
    }
    for entry in std::fs::read_dir(repository().join("examples/examples")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_string_lossy();
        assert!(examples.contains(&format!("| `{name}` |")), "{name} is not in examples.md");
    }
}
