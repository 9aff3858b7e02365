//! `shadowgraph nodes`: what there is to choose from.

use std::fmt::Write as _;

use crate::console;
use crate::failure::Failure;
use shadowgraph::options::{PIPELINES, TECHNIQUES, Technique};
use shadowgraph::permutations;

/// Prints the pipelines, the techniques, and in how many permutations shaders come.
pub(crate) fn nodes() -> Result<(), Failure> {
    let mut out = String::from("pipelines\n");
    for (name, what) in PIPELINES.iter().zip([
        "a depth prepass; each pixel asks for its shadows as it is lit",
        "a depth prepass; shadows are collected in a screen mask, then lit",
        "no prepass; each pixel asks for its shadows as it is lit",
    ]) {
        let _ = writeln!(out, "  {name:<16}{what}");
    }
    out.push_str("\ntechniques, and in how many permutations the shaders of lit passes come\n");
    let _ =
        writeln!(out, "  {:<16}{:>16}{:>16}{:>32}", "", "asked", "collected", "collected, blended surfaces");
    for name in TECHNIQUES {
        let counts = permutations(name.parse::<Technique>()?)?;
        let _ = writeln!(
            out,
            "  {name:<16}{:>16}{:>16}{:>32}",
            counts.asked, counts.collected, counts.collected_and_asked
        );
    }
    out.push_str(
        "\nasked: pipelines forward and minimal; collected: screen_shadows. Each is compiled for those kinds of material\n\
         (opaque, mask, blend; double-sided; mirrored: up to 12) that are drawn, when it is first needed.\n",
    );
    console::print(&out)
}
