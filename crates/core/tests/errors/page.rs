//! The page of examples.

use super::codes;

const PAGE: &str = include_str!("../../../../docs/errors.md");

/// Sections of the page: code, title and text.
fn sections() -> Vec<(&'static str, &'static str, &'static str)> {
    let sections = PAGE.split("\n## ").skip(1);
    sections
        .map(|section| {
            let (heading, text) = section.split_once('\n').unwrap();
            let (code, title) = heading.split_once(' ').unwrap();
            (code, title, text)
        })
        .collect()
}

#[test]
fn every_code_has_one_section_in_order() {
    // The tests of `shadowgraph-inspect` compare SG07.
    let of_core = |code: &&str| !code.starts_with("SG07");
    let of_page: Vec<_> = sections().iter().map(|(code, ..)| *code).filter(of_core).collect();
    let mut of_source = codes();
    of_source.sort_unstable();
    assert_eq!(of_page, of_source);
}

#[test]
fn every_section_has_an_example_that_fails_and_a_fixed_one() {
    for (code, _, text) in sections() {
        let mut blocks: Vec<_> =
            text.split("```rust\n").skip(1).map(|b| b.split("```").next().unwrap()).collect();
        assert_eq!(blocks.len(), 2, "{code}");
        let fixed = blocks.pop().unwrap();
        let fails = blocks.pop().unwrap();
        assert!(fails.contains(&format!("\"{code}\"")) && fails.contains("assert_eq!"), "{code}: {fails}");
        assert!(fixed.contains("is_ok()") && !fixed.contains(code), "{code}: {fixed}");
    }
}

#[test]
fn the_table_links_to_every_section() {
    for (code, title, _) in sections() {
        let anchor = format!("{code} {title}").to_lowercase().replace(' ', "-");
        let row = format!("| [{code}](#{anchor}) | {title} |");
        assert!(PAGE.contains(&row), "{row}");
    }
}
