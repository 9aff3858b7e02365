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
fn failures() -> Vec<(Error, [&'static str; 2])> {
    let plan = Frame::new().compile().unwrap().into_plan();
    vec![
        (explain(&plan, "draw").unwrap_err(), ["`draw`", "`dump` lists all names"]),
        (Dump::from_json(r#"{"schema": 1}"#).unwrap_err(), ["schema version 1", "write the dump again"]),
        #[cfg(feature = "serve")]
        (taken_port(), ["127.0.0.1:", "choose another port"]),
    ]
}

#[cfg(feature = "serve")]
fn taken_port() -> Error {
    let taken = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = taken.local_addr().unwrap().port();
    shadowgraph_inspect::Server::start(port, "second").err().unwrap()
}

#[test]
fn every_error_can_be_caused_and_names_a_fix() {
    for (error, words) in failures() {
        let message = error.to_string();
        assert!(message.starts_with(&format!("{}: ", error.code())), "{message}");
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert!(!message.contains('\n') && !message.contains("  "), "{message}");
    }
    let caused: Vec<_> = failures().iter().map(|(error, _)| error.code()).collect();
    // The last one needs the feature `serve`.
    let possible = if cfg!(feature = "serve") { codes().len() } else { codes().len() - 1 };
    assert_eq!(caused, codes()[..possible]);
}

#[test]
fn every_code_has_a_section_and_the_page_has_no_other_of_this_crate() {
    let headings = PAGE.lines().filter_map(|line| line.strip_prefix("## SG07"));
    let of_page: Vec<_> = headings.map(|rest| format!("SG07{}", &rest[..2])).collect();
    assert_eq!(of_page, codes());
}
