//! `shadowgraph nodes`: what there is to choose from.

use std::fmt::Write as _;

use super::args::NodesArgs;
use super::console;
use super::failure::Failure;
use super::limits::{Check, check_own, check_shared, rows, shared};
use serde_json::Value;
use shadowgraph::core::did_you_mean;
use shadowgraph::pipelines::{BUILT_IN, Pipeline, schema};
use shadowgraph::shadows::{ShadowSettings, Techniques};
use shadowgraph::{Registry, ron_file};

/// Prints all that there is, one of it, or the schema of files.
pub(crate) fn nodes(args: &NodesArgs, registry: &Registry) -> Result<(), Failure> {
    let text = match &args.name {
        _ if args.schema => serde_json::to_string_pretty(&schema(&registry.nodes))? + "\n",
        Some(name) => one(name, registry)?,
        None => all(registry)?,
    };
    console::print(&text)
}

/// All about a pipeline, a kind of node or a technique.
fn one(name: &str, registry: &Registry) -> Result<String, Failure> {
    let Registry { techniques, nodes } = registry;
    let mut told = String::new();
    if let Some(text) = Pipeline::built_in_text(name) {
        let _ = write!(told, "pipeline {name}, as a file\n\n{text}");
    }
    let of_technique = techniques.find(name).is_ok().then(|| technique(name, techniques)).transpose()?;
    let of_all = (name == SHARED).then(shared_settings).transpose()?;
    for text in [nodes.describe(name).ok(), of_technique, of_all].into_iter().flatten() {
        told += if told.is_empty() { "" } else { "\n" };
        told += &text;
    }
    if told.is_empty() {
        let kinds = nodes.kinds().iter().map(|kind| kind.name);
        let of_techniques = techniques.kinds().iter().map(|kind| kind.name);
        let tops = Techniques::modifiers().map(|(top, ..)| top);
        let all = BUILT_IN.iter().copied().chain(kinds).chain(of_techniques).chain(tops).chain([SHARED]);
        let hint = did_you_mean(name, all);
        let message = format!("unknown pipeline, node kind or technique `{name}`{hint}");
        return Err(Failure { code: Failure::INPUT, message });
    }
    Ok(told)
}

/// What the settings that all techniques share are asked for by.
const SHARED: &str = "settings";

/// A technique and what is on top of it, each with its own settings.
fn technique(name: &str, techniques: &Techniques) -> Result<String, Failure> {
    let mut out = String::new();
    for part in name.split('+').map(str::trim) {
        let kind = techniques.kinds().iter().find(|kind| kind.name == part);
        let top = || Techniques::modifiers().find(|(top, ..)| *top == part);
        let (title, summary, defaults) = match kind {
            Some(kind) => (part.to_owned(), kind.summary, kind.default_settings()),
            None => match top() {
                Some((_, summary, defaults)) => (format!("+{part}"), summary, Some(defaults)),
                None => continue,
            },
        };
        let _ = writeln!(out, "technique {title}: {summary}");
        let settings = ShadowSettings::default();
        match techniques.own_settings(part, &settings) {
            Some(own) => {
                let check = |value: &Value| check_own(techniques, part, &settings, value);
                table(&mut out, &own?, &defaults.unwrap_or_default(), &check);
            }
            None => out.push_str("  without settings of its own\n"),
        }
    }
    out.push_str("`nodes settings` lists those that all techniques share\n");
    Ok(out)
}

fn shared_settings() -> Result<String, Failure> {
    let mut out =
        String::from("settings of all techniques, by the path in a file of --settings, with defaults\n");
    let defaults = ShadowSettings::default();
    table(&mut out, &shared(&defaults)?, &ron::to_string(&defaults)?, &check_shared);
    Ok(out)
}

/// Settings with their defaults, as files have them, and what they may be.
fn table(out: &mut String, root: &Value, defaults: &str, check: Check<'_>) {
    for (name, limit) in rows(root, check) {
        let default = spaced(ron_file::value(defaults, &name).unwrap_or_default());
        let words = match (limit.words(), &*default) {
            (words, _) if !words.is_empty() => words,
            (_, "true" | "false") => "true or false".to_owned(),
            (_, list) if list.starts_with('[') => "a list".to_owned(),
            _ => String::new(),
        };
        let allowed = if words.is_empty() { String::new() } else { format!("; {words}") };
        let _ = writeln!(out, "  setting  {name:<32} {default}{allowed}");
    }
}

fn all(registry: &Registry) -> Result<String, Failure> {
    let Registry { techniques, nodes } = registry;
    let mut out = String::from("pipelines; `nodes NAME` prints the file of one\n");
    for pipeline in BUILT_IN.iter().filter_map(|name| name.parse::<Pipeline>().ok()) {
        let _ = writeln!(out, "  {:<16}{}", pipeline.name(), pipeline.about());
    }
    out.push_str("\nkinds of nodes; `nodes NAME` prints ports and settings of one\n");
    for kind in nodes.kinds() {
        let _ = writeln!(out, "  {:<16}{}", kind.name, kind.about);
    }
    out.push_str("\ntechniques, and their own settings as they are by default; `nodes NAME` and `nodes settings` tell of ranges\n");
    for kind in techniques.kinds() {
        let _ = writeln!(out, "  {:<16}{}", kind.name, kind.summary);
        settings(&mut out, kind.name, kind.default_settings());
    }
    out.push_str("\non top of each technique, such as pcf+contact\n");
    for (name, what, defaults) in Techniques::modifiers() {
        let _ = writeln!(out, "  {:<16}{what}", format!("+{name}"));
        settings(&mut out, name, Some(defaults));
    }
    Ok(out)
}

/// What a settings file has in its `techniques`.
fn settings(out: &mut String, name: &str, defaults: Option<String>) {
    if let Some(defaults) = defaults {
        let _ = writeln!(out, "  {:<16}\"{name}\": {}", "", spaced(&defaults));
    }
}

/// RON as people write it.
fn spaced(ron: &str) -> String {
    ron.replace(':', ": ").replace(',', ", ")
}
