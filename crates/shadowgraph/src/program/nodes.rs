//! `shadowgraph nodes`: what there is to choose from.

use std::fmt::Write as _;

use super::console;
use super::failure::Failure;
use crate::options::PIPELINES;
use crate::permutations;
use crate::shadows::Techniques;

/// Prints the pipelines, the techniques and their settings, and in how many permutations shaders come.
pub(crate) fn nodes(techniques: &Techniques) -> Result<(), Failure> {
    let mut out = String::from("pipelines\n");
    for (name, what) in PIPELINES.iter().zip([
        "a depth prepass; each pixel asks for its shadows as it is lit",
        "a depth prepass; shadows are collected in a screen mask, then lit",
        "no prepass; each pixel asks for its shadows as it is lit",
    ]) {
        let _ = writeln!(out, "  {name:<16}{what}");
    }
    out.push_str("\ntechniques, and their own settings as they are by default\n");
    for kind in techniques.kinds() {
        let _ = writeln!(out, "  {:<16}{}", kind.name, kind.summary);
        settings(&mut out, kind.name, kind.default_settings());
    }
    out.push_str("\non top of each technique, such as pcf+contact\n");
    for (name, what, defaults) in Techniques::combinations() {
        let _ = writeln!(out, "  {:<16}{what}", format!("+{name}"));
        settings(&mut out, name, Some(defaults));
    }
    out.push_str("\nin how many permutations the shaders of lit passes come\n");
    let _ =
        writeln!(out, "  {:<16}{:>16}{:>16}{:>32}", "", "asked", "collected", "collected, blended surfaces");
    for kind in techniques.kinds() {
        let counts = permutations((*kind).into())?;
        let _ = writeln!(
            out,
            "  {:<16}{:>16}{:>16}{:>32}",
            kind.name, counts.asked, counts.collected, counts.collected_and_asked
        );
    }
    out.push_str(
        "\nasked: pipelines forward and minimal; collected: screen_shadows. Each is compiled for those kinds of material\n\
         (opaque, mask, blend; double-sided; mirrored: up to 12) that are drawn, when it is first needed.\n",
    );
    console::print(&out)
}

/// What a settings file has in its `techniques`.
fn settings(out: &mut String, name: &str, defaults: Option<String>) {
    if let Some(defaults) = defaults {
        let _ = writeln!(out, "  {:<16}\"{name}\": {}", "", defaults.replace(':', ": ").replace(',', ", "));
    }
}
