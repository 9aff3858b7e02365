//! `shadowgraph nodes`: pipelines, nodes, techniques and settings.

use std::fmt::Write as _;

use super::args::NodesArgs;
use super::console;
use super::failure::Failure;
use shadowgraph::Registry;
use shadowgraph::core::did_you_mean;
use shadowgraph::pipelines::{BUILT_IN, Pipeline, schema};
use shadowgraph::shadows::{DescribeSettings, Setting, SettingType, ShadowSettings, Techniques};
use shadowgraph_quality::TextTable;

/// Prints the overview, a description of one thing, or the JSON Schema of files.
pub(crate) fn nodes(args: &NodesArgs, registry: &Registry) -> Result<(), Failure> {
    let text = match args.name.as_deref() {
        Some(SETTINGS) if args.schema => {
            serde_json::to_string_pretty(&registry.techniques.settings_schema())? + "\n"
        }
        Some(name) if args.schema => return Err(no_schema(name)),
        None if args.schema => serde_json::to_string_pretty(&schema(&registry.nodes))? + "\n",
        Some(name) => one(name, registry)?,
        None => all(registry),
    };
    console::print(&text)
}

fn no_schema(name: &str) -> Failure {
    let message = format!(
        "--schema: `{name}` has no schema; allowed: no name (pipeline files) or `{SETTINGS}` (settings files)"
    );
    Failure { code: Failure::USAGE, message }
}

/// Describes a pipeline, a kind of node, a technique or the shared settings.
fn one(name: &str, registry: &Registry) -> Result<String, Failure> {
    let Registry { techniques, nodes } = registry;
    let mut out = String::new();
    if let Some(text) = Pipeline::built_in_text(name) {
        let _ = write!(out, "pipeline {name}, as a file\n\n{text}");
    }
    let technique = techniques.find(name).is_ok().then(|| technique(name, techniques));
    let shared = (name == SETTINGS).then(shared_settings);
    for text in [nodes.describe(name).ok(), technique, shared].into_iter().flatten() {
        out += if out.is_empty() { "" } else { "\n" };
        out += &text;
    }
    if out.is_empty() {
        let kinds = nodes.kinds().iter().map(|kind| kind.name);
        let names = techniques.kinds().iter().map(|kind| kind.name);
        let modifiers = Techniques::modifiers().map(|modifier| modifier.name);
        let all = BUILT_IN.iter().copied().chain(kinds).chain(names).chain(modifiers).chain([SETTINGS]);
        let hint = did_you_mean(name, all);
        let message = format!("unknown pipeline, node kind or technique `{name}`{hint}");
        return Err(Failure { code: Failure::INPUT, message });
    }
    Ok(out)
}

/// The name that stands for the settings that all techniques share.
const SETTINGS: &str = "settings";

/// Describes a technique and its modifiers with their settings.
fn technique(name: &str, techniques: &Techniques) -> String {
    let mut out = String::new();
    for part in name.split('+').map(str::trim) {
        let kind = techniques.kinds().iter().find(|kind| kind.name == part);
        let modifier = || Techniques::modifiers().find(|modifier| modifier.name == part);
        let (title, summary, settings) = match kind {
            Some(kind) => (part.to_owned(), kind.summary, kind.settings()),
            None => match modifier() {
                Some(modifier) => (format!("+{part}"), modifier.summary, modifier.settings),
                None => continue,
            },
        };
        let _ = writeln!(out, "technique {title}: {summary}");
        out += &settings_table(settings);
        if settings.is_empty() {
            out.push_str("  no settings\n");
        }
    }
    out.push_str("`nodes settings` lists the settings that all techniques share\n");
    out
}

fn shared_settings() -> String {
    let heading =
        "settings that all techniques share, by their path in a settings file (--settings), with defaults\n";
    heading.to_owned() + &settings_table(ShadowSettings::settings())
}

/// Returns one line for each setting.
fn settings_table(settings: &[Setting]) -> String {
    let mut rows = Vec::new();
    add_settings(&mut rows, "", settings);
    table("lll", rows)
}

/// Adds a row for each setting, with the path of its struct before its name.
fn add_settings(rows: &mut Vec<[String; 3]>, parent: &str, settings: &[Setting]) {
    for setting in settings {
        let path = format!("{parent}{}", setting.name);
        match setting.ty {
            SettingType::Struct(fields) => add_settings(rows, &format!("{path}."), fields),
            SettingType::List(_, SettingType::Struct(fields)) => {
                add_settings(rows, &format!("{path}[]."), fields);
            }
            _ => rows.push(["setting".into(), path, setting.describe()]),
        }
    }
}

/// Formats rows of names and descriptions, which may be long.
fn table<const N: usize>(alignment: &str, rows: Vec<[String; N]>) -> String {
    TextTable { alignment, indent: 2, width: usize::MAX }.format(rows)
}

fn all(registry: &Registry) -> String {
    let Registry { techniques, nodes } = registry;
    let pipelines = BUILT_IN.iter().filter_map(|name| name.parse::<Pipeline>().ok());
    let pipelines = pipelines.map(|pipeline| [pipeline.name().into(), pipeline.about().into()]);
    let kinds = nodes.kinds().iter().map(|kind| [kind.name.into(), kind.about.into()]);
    let of_techniques = techniques.kinds().iter().flat_map(|kind| {
        let row = [kind.name.into(), kind.summary.into()];
        [row].into_iter().chain(defaults(kind.name, kind.settings()))
    });
    let modifiers = Techniques::modifiers().flat_map(|modifier| {
        let row = [format!("+{}", modifier.name), modifier.summary.into()];
        [row].into_iter().chain(defaults(modifier.name, modifier.settings))
    });
    format!(
        "pipelines; `nodes NAME` prints the file of one\n{}\n\
         node kinds; `nodes NAME` prints the ports and settings of one\n{}\n\
         techniques, with the defaults of their settings; `nodes NAME` describes the settings of one\n{}\n\
         modifiers of techniques, as in pcf+contact; `nodes contact` describes the settings of one\n{}",
        table("ll", pipelines.collect()),
        table("ll", kinds.collect()),
        table("ll", of_techniques.collect()),
        table("ll", modifiers.collect()),
    )
}

/// Returns settings as the field `techniques` of a settings file has them; `None` without settings.
fn defaults(name: &str, settings: &'static [Setting]) -> Option<[String; 2]> {
    let ty = SettingType::Struct(settings);
    (!settings.is_empty()).then(|| [String::new(), format!("\"{name}\": {}", ty.ron(&ty.default_value()))])
}
