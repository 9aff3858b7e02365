//! A pipeline file as data, each part with its location.

use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use ron::value::RawValue;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::source::{SourceText, Spanned, parse, parse_raw};
use crate::error::PipelineError;

/// The contents of a file. All but `nodes` can be left out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Document {
    pub(super) about: String,
    pub(super) parameters: Pairs<Value>,
    pub(super) nodes: Vec<NodeEntry>,
    pub(super) outputs: Vec<Connection>,
}

/// A node of the file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct NodeEntry {
    pub(super) name: Spanned<String>,
    pub(super) kind: Spanned<String>,
    pub(super) inputs: Vec<Connection>,
    pub(super) settings: Pairs<Value>,
    pub(super) when: Option<Spanned<Condition>>,
}

/// Entries of a map, in the order of the file.
pub(super) type Pairs<T> = Vec<(Spanned<String>, Spanned<T>)>;

/// An input and the outputs that it is connected to: the first whose node is enabled counts.
pub(super) type Connection = (Spanned<String>, Vec<Spanned<String>>);

/// Condition under which a node is enabled.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) enum Condition {
    /// The parameter is true.
    On(String),
    Not(Box<Condition>),
}

/// A map of the file in its order, with duplicates.
struct Entries<'t, T>(Vec<(&'t RawValue, T)>);

impl<T> Default for Entries<'_, T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de: 't, 't, T: Deserialize<'de>> Deserialize<'de> for Entries<'t, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader<'t, T>(PhantomData<(&'t (), T)>);
        impl<'de: 't, 't, T: Deserialize<'de>> Visitor<'de> for Reader<'t, T> {
            type Value = Entries<'t, T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map, such as {\"light\": \"lighting.light\"}")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Reader(PhantomData))
    }
}

#[derive(Deserialize)]
#[serde(rename = "", deny_unknown_fields)]
struct RawDocument<'t> {
    #[serde(default)]
    about: String,
    #[serde(borrow, default)]
    parameters: Entries<'t, &'t RawValue>,
    #[serde(borrow)]
    nodes: Vec<&'t RawValue>,
    #[serde(borrow, default)]
    outputs: Entries<'t, &'t RawValue>,
}

#[derive(Deserialize)]
#[serde(rename = "", deny_unknown_fields)]
struct RawNodeEntry<'t> {
    #[serde(borrow)]
    name: &'t RawValue,
    #[serde(borrow)]
    kind: &'t RawValue,
    #[serde(borrow, default)]
    inputs: Entries<'t, &'t RawValue>,
    #[serde(borrow, default)]
    settings: Entries<'t, &'t RawValue>,
    #[serde(borrow, default)]
    when: Option<&'t RawValue>,
}

impl Document {
    /// Parses the text of a file.
    pub(super) fn parse(source: &Arc<SourceText>) -> Result<Self, PipelineError> {
        let raw: RawDocument<'_> = parse(source, &source.text, 0)?;
        Ok(Self {
            about: raw.about,
            parameters: pairs(source, raw.parameters, "parameter")?,
            nodes: raw.nodes.into_iter().map(|raw| node_entry(source, raw)).collect::<Result<_, _>>()?,
            outputs: connections(source, raw.outputs, "output")?,
        })
    }

    /// Returns the entry of a node.
    pub(super) fn entry(&self, node: &str) -> Option<&NodeEntry> {
        self.nodes.iter().find(|entry| entry.name.value == node)
    }
}

fn node_entry(source: &Arc<SourceText>, raw: &RawValue) -> Result<NodeEntry, PipelineError> {
    let entry: Spanned<RawNodeEntry<'_>> = parse_raw(source, raw)?;
    let RawNodeEntry { name, kind, inputs, settings, when } = entry.value;
    Ok(NodeEntry {
        name: parse_raw(source, name)?,
        kind: parse_raw(source, kind)?,
        inputs: connections(source, inputs, "input")?,
        settings: pairs(source, settings, "setting")?,
        when: when.map(|raw| parse_raw(source, raw)).transpose()?,
    })
}

/// Parses the entries of a map and refuses duplicates; `what` names an entry in the error.
fn pairs<T: for<'de> Deserialize<'de>>(
    source: &Arc<SourceText>,
    entries: Entries<'_, &RawValue>,
    what: &str,
) -> Result<Pairs<T>, PipelineError> {
    let mut found: Pairs<T> = Vec::new();
    for (name, value) in entries.0 {
        let name: Spanned<String> = parse_raw(source, name)?;
        if found.iter().any(|(known, _)| known.value == name.value) {
            return Err(name.error(format!("duplicate {what} `{}`", name.value)));
        }
        found.push((name, parse_raw(source, value)?));
    }
    Ok(found)
}

fn connections(
    source: &Arc<SourceText>,
    entries: Entries<'_, &RawValue>,
    what: &str,
) -> Result<Vec<Connection>, PipelineError> {
    let pairs: Pairs<Value> = pairs(source, entries, what)?;
    let connection = |(name, outputs): (Spanned<String>, Spanned<Value>)| {
        let one = |value: &Value| {
            let text = value.as_str().ok_or_else(|| {
                outputs.error("expected the name of an output, such as \"lighting.light\", or a list of them")
            })?;
            Ok(Spanned { value: text.to_owned(), location: outputs.location.clone() })
        };
        let outputs = match &outputs.value {
            Value::Array(several) => several.iter().map(one).collect::<Result<_, _>>()?,
            value => vec![one(value)?],
        };
        Ok((name, outputs))
    };
    pairs.into_iter().map(connection).collect()
}
