//! Every error can be caused through the public API, and has a section in `docs/errors.md`. The examples there are doctests.
#![allow(clippy::unwrap_used, reason = "tests")]

use shadowgraph_core::Frame;
use shadowgraph_inspect::{Dump, Error, explain};

const PAGE: &str = include_str!("../../../docs/errors.md");

/// Codes in the source, in the order of the variants.
fn codes() -> Vec<&'static str> {
    let source = include_str!("../src/error.rs");
    let arm = |line: &'static str| line.trim().strip_prefix("Self::")?.split_once("=> \"")?.1.get(..6);
    source.lines().filter_map(arm).collect()
}

/// An error with every code, and texts that its message must contain.
fn failures() -> [(Error, [&'static str; 2]); 2] {
    let plan = Frame::new().compile().unwrap().into_plan();
    [
        (explain(&plan, "draw").unwrap_err(), ["`draw`", "`dump` lists all names"]),
        (Dump::from_json(r#"{"schema": 1}"#).unwrap_err(), ["schema version 1", "write the dump again"]),
    ]
}

#[test]
fn every_error_can_be_caused_and_names_a_fix() {
    for (error, words) in failures() {
        let message = error.to_string();
        assert!(message.starts_with(&format!("{}: ", error.code())), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert!(!message.contains('\n') && !message.contains("  "), "{message}");
    }
    assert_eq!(failures().map(|(error, _)| error.code()).to_vec(), codes());
}

#[test]
fn every_code_has_a_section_and_the_page_has_no_other_of_this_crate() {
    let headings = PAGE.lines().filter_map(|line| line.strip_prefix("## SG07"));
    let of_page: Vec<_> = headings.map(|rest| format!("SG07{}", &rest[..2])).collect();
    assert_eq!(of_page, codes());
}
