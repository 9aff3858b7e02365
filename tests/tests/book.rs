//! The book: every page is in it, its includes and links lead somewhere, and mdBook can read it.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use shadowgraph::options::SettingsFile;
use shadowgraph::shadows::Techniques;
use shadowgraph_tests::features::{FEATURES, Feature, PLAIN};
use shadowgraph_tests::repository;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

fn pages() -> Vec<PathBuf> {
    let files = std::fs::read_dir(repository().join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<_> = files.filter(|path| path.extension().is_some_and(|is| is == "md")).collect();
    pages.sort();
    pages
}

/// Returns the text of a page without its code.
fn prose(page: &Path) -> String {
    let text = std::fs::read_to_string(page).unwrap();
    let mut in_code = false;
    let lines = text.lines().filter(|line| {
        let fence = line.trim_start().starts_with("```");
        in_code ^= fence;
        !in_code && !fence
    });
    lines.collect::<Vec<_>>().join("\n")
}

/// Returns the targets of a text's links.
fn links(text: &str) -> Vec<&str> {
    text.split("](").skip(1).filter_map(|rest| rest.split(')').next()).collect()
}

/// Returns the anchors of a page's headings.
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

/// Returns the paths of all images, relative to `docs/images`.
fn images() -> BTreeSet<String> {
    let root = repository().join("docs/images");
    let mut names = BTreeSet::new();
    let mut dirs = vec![root.clone()];
    while let Some(dir) = dirs.pop() {
        for path in std::fs::read_dir(dir).unwrap().map(|entry| entry.unwrap().path()) {
            if path.is_dir() {
                dirs.push(path);
            } else {
                names.insert(path.strip_prefix(&root).unwrap().to_string_lossy().replace('\\', "/"));
            }
        }
    }
    names
}

#[test]
fn every_image_of_the_documents_is_used() {
    let texts: String = pages().iter().map(|page| prose(page)).collect();
    for name in images() {
        assert!(texts.contains(&format!("](images/{name})")), "{name} is in no page");
    }
}

#[test]
fn every_image_of_the_documents_is_drawn_by_a_command() {
    let list = std::fs::read_to_string(repository().join("xtask/images.txt")).unwrap();
    let names = list.lines().filter(|line| !line.is_empty() && !line.starts_with(['#', ' ']));
    let drawn: BTreeSet<String> =
        names.map(|line| format!("{}.png", line.split(' ').next().unwrap())).collect();
    assert_eq!(drawn, images(), "xtask/images.txt and docs/images");
}

#[test]
fn the_settings_of_every_drawn_image_are_valid() {
    let list = std::fs::read_to_string(repository().join("xtask/images.txt")).unwrap();
    let file = tempfile::NamedTempFile::new().unwrap();
    let mut count = 0;
    for line in list.lines().filter(|line| !line.starts_with('#')) {
        let Some((_, settings)) = line.split_once(" settings ") else { continue };
        let settings = settings.split_once(" -> ").map_or(settings, |(settings, _)| settings);
        std::fs::write(file.path(), settings).unwrap();
        let loaded = SettingsFile::load(file.path(), &Techniques::built_in());
        assert!(loaded.is_ok(), "{line}: {:?}", loaded.err());
        count += 1;
    }
    assert!(count > 40, "{count}");
}

/// Returns the targets of a page's `{{#include target}}`, the page's only preprocessor command.
fn includes(page: &Path) -> Vec<String> {
    let text = std::fs::read_to_string(page).unwrap();
    let commands = text.split("{{#").skip(1).map(|rest| rest.split("}}").next().unwrap());
    commands
        .map(|command| {
            command.strip_prefix("include ").unwrap_or_else(|| panic!("{}: {command}", page.display())).into()
        })
        .collect()
}

/// Returns the text that mdBook includes for a target: a file, or the part of it between `ANCHOR: x` and `ANCHOR_END: x`.
fn included(target: &str) -> String {
    let (file, anchor) = target.split_once(':').unwrap_or((target, ""));
    let text = std::fs::read_to_string(repository().join("docs").join(file))
        .unwrap_or_else(|error| panic!("{target}: {error}"));
    if anchor.is_empty() {
        return text;
    }
    let is_mark = |line: &str, mark: &str| {
        line.split_once(mark).is_some_and(|(_, rest)| rest.split_whitespace().next() == Some(anchor))
    };
    let mut after = text.lines().skip_while(|line| !is_mark(line, "ANCHOR: ")).skip(1);
    let mut part = Vec::new();
    loop {
        let line = after.next().unwrap_or_else(|| panic!("{target}: no such part"));
        if is_mark(line, "ANCHOR_END: ") {
            return part.join("\n");
        }
        part.push(line);
    }
}

#[test]
fn every_included_file_and_part_exists_and_its_links_hold_in_the_book() {
    let targets: Vec<String> = pages().iter().flat_map(|page| includes(page)).collect();
    assert!(targets.len() >= 3, "{targets:?}");
    for target in targets {
        let text = included(&target);
        assert!(!text.trim().is_empty(), "{target} is empty");
        for link in links(&text).into_iter().filter(|link| !link.starts_with("https://")) {
            let file = link.split_once('#').map_or(link, |(file, _)| file);
            let in_book = !file.starts_with("..") && repository().join("docs").join(file).exists();
            assert!(in_book, "{target}: {link} leads out of the book");
        }
    }
}

/// The rules by which mdBook reads the list of chapters.
#[test]
fn the_summary_is_a_list_of_links_each_of_them_once() {
    let summary = std::fs::read_to_string(repository().join("docs/SUMMARY.md")).unwrap();
    let mut seen = BTreeSet::new();
    let mut depth = 0;
    for line in summary.lines().filter(|line| !line.is_empty() && !line.starts_with("# ")) {
        let item = line.trim_start();
        let indent = line.len() - item.len();
        assert!(indent % 2 == 0 && indent <= depth + 2, "{line}");
        depth = indent;
        let link = item.strip_prefix("- [").and_then(|item| item.strip_suffix(".md)"));
        assert!(link.is_some_and(|link| link.matches("](").count() == 1), "{line}");
        assert!(seen.insert(links(item)[0]), "duplicate chapter: {line}");
    }
}

#[test]
fn every_code_block_of_a_page_is_closed() {
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        let fences = text.lines().filter(|line| line.trim_start().starts_with("```")).count();
        assert_eq!(fences % 2, 0, "{}", page.display());
    }
}

#[test]
fn every_node_kind_and_every_example_is_documented() {
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

#[test]
fn the_page_of_files_lists_every_feature_that_is_drawn() {
    let page = std::fs::read_to_string(repository().join("docs/files.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| `")).collect::<Vec<_>>();
    let row =
        |feature: &Feature| format!("| `{}` | {} | {} |", feature.name, feature.extension, feature.drawn);
    assert_eq!(rows, [PLAIN].iter().chain(&FEATURES).map(row).collect::<Vec<_>>());
}
