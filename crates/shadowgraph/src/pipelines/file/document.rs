//! A pipeline file as data, each part with its place.

use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

use ron::value::RawValue;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::source::{PipelineError, Source, Spot, parse, read};

/// What the program reads of a file. All but `nodes` can be left out.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Document {
    pub(super) about: String,
    pub(super) include: Vec<Spot<String>>,
    pub(super) parameters: Pairs<Value>,
    pub(super) tiers: Vec<(Spot<String>, Pairs<Value>)>,
    pub(super) tier_for: Pairs<String>,
    pub(super) nodes: Vec<Entry>,
    pub(super) outputs: Vec<Feed>,
}

/// A node.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Entry {
    pub(super) name: Spot<String>,
    pub(super) kind: Spot<String>,
    pub(super) inputs: Vec<Feed>,
    pub(super) settings: Pairs<Value>,
    pub(super) when: Option<Spot<Condition>>,
}

/// Entries of a map, in the order of the file.
pub(super) type Pairs<T> = Vec<(Spot<String>, Spot<T>)>;

/// An input and what feeds it: the first of these that is there.
pub(super) type Feed = (Spot<String>, Vec<Spot<String>>);

/// When a node is there.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) enum Condition {
    /// The parameter is true.
    On(String),
    /// The parameter has this value.
    Is(String, Value),
    Not(Box<Condition>),
    All(Vec<Condition>),
    Any(Vec<Condition>),
}

/// A map as it stands in the file: in order, and with what stands there twice.
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
    include: Vec<&'t RawValue>,
    #[serde(borrow, default)]
    parameters: Entries<'t, &'t RawValue>,
    #[serde(borrow, default)]
    tiers: Entries<'t, Entries<'t, &'t RawValue>>,
    #[serde(borrow, default)]
    tier_for: Entries<'t, &'t RawValue>,
    #[serde(borrow)]
    nodes: Vec<&'t RawValue>,
    #[serde(borrow, default)]
    outputs: Entries<'t, &'t RawValue>,
}

#[derive(Deserialize)]
#[serde(rename = "", deny_unknown_fields)]
struct RawEntry<'t> {
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
    /// Reads a file's text.
    pub(super) fn parse(source: &Arc<Source>) -> Result<Self, PipelineError> {
        let raw: RawDocument<'_> = parse(source, &source.text, 0)?;
        let tier = |(name, values): (&RawValue, Entries<'_, _>)| {
            Ok((read(source, name)?, pairs(source, values, "the parameter")?))
        };
        Ok(Self {
            about: raw.about,
            include: raw.include.into_iter().map(|raw| read(source, raw)).collect::<Result<_, _>>()?,
            parameters: pairs(source, raw.parameters, "the parameter")?,
            tiers: raw.tiers.0.into_iter().map(tier).collect::<Result<_, _>>()?,
            tier_for: pairs(source, raw.tier_for, "the tier for")?,
            nodes: raw.nodes.into_iter().map(|raw| entry(source, raw)).collect::<Result<_, _>>()?,
            outputs: feeds(source, raw.outputs, "the output")?,
        })
    }
}

fn entry(source: &Arc<Source>, raw: &RawValue) -> Result<Entry, PipelineError> {
    let entry: Spot<RawEntry<'_>> = read(source, raw)?;
    let RawEntry { name, kind, inputs, settings, when } = entry.value;
    Ok(Entry {
        name: read(source, name)?,
        kind: read(source, kind)?,
        inputs: feeds(source, inputs, "the input")?,
        settings: pairs(source, settings, "the setting")?,
        when: when.map(|raw| read(source, raw)).transpose()?,
    })
}

/// The entries of a map, each name once; `what` they are is for the error.
fn pairs<T: for<'de> Deserialize<'de>>(
    source: &Arc<Source>,
    entries: Entries<'_, &RawValue>,
    what: &str,
) -> Result<Pairs<T>, PipelineError> {
    let mut found: Pairs<T> = Vec::new();
    for (name, value) in entries.0 {
        let name: Spot<String> = read(source, name)?;
        if found.iter().any(|(known, _)| known.value == name.value) {
            return Err(name.error(format!("{what} `{}` stands here twice: keep one", name.value)));
        }
        found.push((name, read(source, value)?));
    }
    Ok(found)
}

fn feeds(
    source: &Arc<Source>,
    entries: Entries<'_, &RawValue>,
    what: &str,
) -> Result<Vec<Feed>, PipelineError> {
    let pairs: Pairs<Value> = pairs(source, entries, what)?;
    let feed = |(name, from): (Spot<String>, Spot<Value>)| {
        let one = |value: &Value| {
            let text = value.as_str().ok_or_else(|| {
                from.error("an output is named by a text such as \"lighting.light\", or several in a list")
            })?;
            Ok(Spot { value: text.to_owned(), place: from.place.clone() })
        };
        let outputs = match &from.value {
            Value::Array(several) => several.iter().map(one).collect::<Result<_, _>>()?,
            value => vec![one(value)?],
        };
        Ok((name, outputs))
    };
    pairs.into_iter().map(feed).collect()
}
