//! Every error can be caused through the public API, names the pass, the resource and a fix, and has a section in
//! `docs/errors.md`. The examples there are doctests.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "tests")]

#[path = "errors/declared.rs"]
mod declared;
#[cfg(feature = "gpu")]
#[path = "errors/executed.rs"]
mod executed;
#[path = "errors/page.rs"]
mod page;

use shadowgraph_core::{Error, Format, TextureDesc};
use std::collections::BTreeSet;

/// An error, its expected code, and texts that its message must contain.
struct Failure {
    code: &'static str,
    error: Error,
    words: &'static [&'static str],
}

fn square() -> TextureDesc {
    TextureDesc::d2(64, 64, Format::Rgba8Unorm)
}

/// Codes in the source, in the order of the variants.
fn codes() -> Vec<&'static str> {
    let source = include_str!("../src/error.rs");
    let arm = |line: &'static str| line.trim().strip_prefix("Self::")?.split_once("=> \"")?.1.get(..6);
    source.lines().filter_map(arm).collect()
}

fn check(failures: Vec<Failure>) -> BTreeSet<&'static str> {
    for Failure { code, error, words } in &failures {
        let named = error.to_string();
        let message = without_places(&named);
        assert!(message != named || !message.contains("pass `"), "a pass has its place: {message}");
        assert_eq!(error.code(), *code, "{message}");
        assert!(message.starts_with(&format!("{code}: ")), "{message}");
        for word in *words {
            assert!(message.contains(word), "{word:?} is missing in: {message}");
        }
        // Of a shader it has wgpu's words, which point into the text.
        let one_line = !message.contains('\n') && !message.contains("  ");
        assert!(one_line || *code == "SG0604", "{message}");
    }
    failures.iter().map(|failure| failure.code).collect()
}

/// Returns a message without the places in which passes are declared. Each is in one of the files of this test.
fn without_places(message: &str) -> String {
    let mut parts = message.split(" (crates");
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |text, part| {
        let (place, rest) = part.split_once(')').unwrap();
        assert!(["declared.rs:", "executed.rs:"].iter().any(|file| place.contains(file)), "{message}");
        text + rest
    })
}

#[test]
fn codes_are_unique_and_each_begins_one_message() {
    let codes = codes();
    assert!(codes.len() >= 26, "{codes:?}");
    let unique: BTreeSet<_> = codes.iter().collect();
    assert_eq!(unique.len(), codes.len(), "{codes:?}");
    let source = include_str!("../src/error.rs");
    for code in codes {
        assert_eq!(source.matches(&format!("\"{code}: ")).count(), 1, "{code} begins one message");
    }
}

#[test]
fn every_error_can_be_caused_and_names_pass_resource_and_fix() {
    let found_by_compile = check(declared::failures());
    #[cfg(feature = "gpu")]
    let found_by_devices = check(executed::failures());
    #[cfg(not(feature = "gpu"))]
    let found_by_devices = BTreeSet::new();
    let had: BTreeSet<_> = found_by_compile.union(&found_by_devices).copied().collect();
    let of_devices =
        ["SG0104", "SG0404", "SG0601", "SG0602", "SG0603", "SG0604", "SG0605", "SG0606", "SG0607", "SG0608"];
    let mut expected: BTreeSet<_> =
        codes().into_iter().filter(|code| cfg!(feature = "gpu") || !of_devices.contains(code)).collect();
    if !had.contains("SG0607") {
        // Only a driver runs out of memory; `execute/tests/lost.rs` says so where there is none.
        expected.remove("SG0607");
    }
    assert_eq!(had, expected);
}
