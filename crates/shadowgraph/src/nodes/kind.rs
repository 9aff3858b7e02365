//! Kinds of nodes as values.

use std::fmt::Write as _;

use serde_json::json;

use super::node::{AnyNode, Node};
use super::port::{Port, Presence};
use super::setting::{Setting, Settings};
use crate::build_context::BuildContext;
use crate::error::Error;

type BuildFn = fn(&BuildContext<'_>, &Settings) -> Result<Box<dyn AnyNode>, Error>;

/// The description of a kind of node.
#[derive(Clone, Copy, Debug)]
pub struct NodeKind {
    /// The name in pipelines.
    pub name: &'static str,
    /// Describes the node in a phrase.
    pub about: &'static str,
    /// The inputs.
    pub inputs: &'static [Port],
    /// The outputs.
    pub outputs: &'static [Port],
    /// The settings.
    pub settings: &'static [Setting],
    pub(crate) groups_itself: bool,
    pub(crate) temporal: bool,
    pub(crate) build: BuildFn,
}

impl NodeKind {
    pub(crate) fn new<N: Node>() -> Self {
        Self {
            name: N::NAME,
            about: N::ABOUT,
            inputs: N::INPUTS,
            outputs: N::OUTPUTS,
            settings: N::SETTINGS,
            groups_itself: N::GROUPS_ITSELF,
            temporal: N::TEMPORAL,
            build: |context, settings| Ok(Box::new(N::new(context, settings)?)),
        }
    }

    /// Returns the JSON Schema of a node of this kind in a pipeline file.
    pub fn schema(&self) -> serde_json::Value {
        let inputs = self.inputs.iter().map(|port| {
            let description = format!("{}: {}", port.kind.name(), port.about);
            let output = json!({ "type": "string" });
            let schema = json!({
                "description": description,
                "anyOf": [output, { "type": "array", "items": output }],
            });
            (port.name.to_owned(), schema)
        });
        let required = |port: &&Port| port.presence == Presence::Required;
        let required: Vec<&str> = self.inputs.iter().filter(required).map(|port| port.name).collect();
        let settings = self.settings.iter().map(|setting| (setting.name.to_owned(), setting.schema()));
        json!({
            "description": self.about,
            "type": "object",
            "properties": {
                "name": { "type": "string" },
                "kind": { "const": self.name },
                "inputs": {
                    "type": "object",
                    "properties": inputs.collect::<serde_json::Map<_, _>>(),
                    "required": required,
                    "additionalProperties": false,
                },
                "settings": {
                    "type": "object",
                    "properties": settings.collect::<serde_json::Map<_, _>>(),
                    "additionalProperties": false,
                },
                "when": {},
            },
            "required": ["name", "kind"],
            "additionalProperties": false,
        })
    }

    /// Returns a description of the ports and settings, with ranges, units and defaults.
    pub(crate) fn describe(&self) -> String {
        let mut out = format!("{}: {}\n", self.name, self.about);
        for (title, ports) in [("input", self.inputs), ("output", self.outputs)] {
            for port in ports {
                let format = port.format.map_or(String::new(), |format| format!(" {format:?}"));
                let presence = match port.presence {
                    Presence::Required => String::new(),
                    Presence::Optional => ", optional".to_owned(),
                    Presence::Placeholder([red, green, blue, alpha]) => {
                        format!(", default ({red:?}, {green:?}, {blue:?}, {alpha:?})")
                    }
                };
                let (name, kind, about) = (port.name, port.kind.name(), port.about);
                let in_place = if port.in_place { ", overwritten in place" } else { "" };
                let _ = writeln!(out, "  {title:<7}  {name:<18} {kind}{format}{presence}{in_place}: {about}");
            }
        }
        for setting in self.settings {
            let _ = writeln!(out, "  setting  {:<18} {}", setting.name, setting.describe());
        }
        out
    }
}
