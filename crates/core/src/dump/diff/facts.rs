//! A dump as names and what is so of them.

use super::Subject;
use crate::access::Access;
use crate::dump::json::SCHEMA;
use crate::dump::words::bytes;
use crate::error::Error;
use crate::plan::Plan;
use crate::subresource::Subresource;
use serde::Deserialize as _;
use serde_json::Value;
use std::collections::BTreeMap;

/// By subject and name: how it is; several where several have the name.
pub(super) type Facts = BTreeMap<(Subject, String), Vec<String>>;

/// A frame as its dump tells of it, to be compared with another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dump {
    pub(super) facts: Facts,
}

impl Dump {
    /// Reads a dump, as [`Plan::to_json`] writes it.
    ///
    /// # Errors
    /// [`Error::Dump`] where the text is no dump, or one of another schema.
    pub fn from_json(json: &str) -> Result<Self, Error> {
        let dump =
            serde_json::from_str(json).map_err(|error| no_dump(&format!("it is not JSON: {error}")))?;
        Self::of_value(&dump)
    }

    pub(super) fn of(plan: &Plan) -> Result<Self, Error> {
        let dump = serde_json::to_value(plan.document()).map_err(|error| no_dump(&error.to_string()))?;
        Self::of_value(&dump)
    }

    fn of_value(dump: &Value) -> Result<Self, Error> {
        match dump.get("schema").and_then(Value::as_u64) {
            Some(schema) if schema == u64::from(SCHEMA) => {}
            Some(schema) => {
                return Err(no_dump(&format!("it has schema {schema}, and {SCHEMA} is read: write it anew")));
            }
            None => return Err(no_dump("it has no `schema`")),
        }
        let facts = Reader { dump, facts: Facts::new() }.read();
        Ok(Self { facts: facts.ok_or_else(|| no_dump("a part of it is missing"))? })
    }
}

fn no_dump(problem: &str) -> Error {
    Error::Dump { problem: problem.into() }
}

struct Reader<'d> {
    dump: &'d Value,
    facts: Facts,
}

impl Reader<'_> {
    /// `None` where a field is missing.
    fn read(mut self) -> Option<Facts> {
        self.summary()?;
        let plan = self.dump.get("plan")?;
        let nodes = plan.get("nodes")?.as_array()?;
        let paths: Vec<String> =
            (0..nodes.len()).map(|node| node_path(nodes, node)).collect::<Option<_>>()?;
        for path in &paths {
            self.add(Subject::Node, path.clone(), String::new());
        }
        let path = |thing: &Value| {
            let name = text(thing, "name")?;
            Some(match thing.get("node").and_then(Value::as_u64) {
                Some(node) => format!("{}/{name}", paths.get(node as usize)?),
                None => name.to_owned(),
            })
        };
        let resources = plan.get("resources")?.as_array()?;
        for resource in resources {
            self.add(Subject::Resource, path(resource)?, resource_words(resource)?);
        }
        for pass in plan.get("passes")?.as_array()? {
            let own = path(pass)?;
            for access in pass.get("accesses")?.as_array()? {
                let resource = resources.get(access.get("resource")?.as_u64()? as usize)?;
                self.add(Subject::Access, format!("{own} · {}", path(resource)?), access_words(access)?);
            }
            let kept = if pass.get("keep")?.as_bool()? { ", kept" } else { "" };
            self.add(Subject::Pass, own, format!("{}{kept}", text(pass, "kind")?.to_lowercase()));
        }
        for reason in self.dump.get("reasons")?.as_array()? {
            let who = ["pass", "resource", "part", "decision"].iter().filter_map(|key| text(reason, key));
            let name = who.collect::<Vec<_>>().join(" · ");
            self.add(
                Subject::Decision,
                name,
                format!("{}: {}", text(reason, "action")?, text(reason, "because")?),
            );
        }
        Some(self.facts)
    }

    fn summary(&mut self) -> Option<()> {
        let summary = self.dump.get("summary")?.as_object()?;
        for (name, value) in summary {
            let value = value.as_u64()?;
            let words = if name.ends_with("bytes") { bytes(value) } else { value.to_string() };
            self.add(Subject::Summary, name.replace("_bytes", " memory"), words);
        }
        Some(())
    }

    fn add(&mut self, subject: Subject, name: String, fact: String) {
        self.facts.entry((subject, name)).or_default().push(fact);
    }
}

fn text<'v>(value: &'v Value, key: &str) -> Option<&'v str> {
    value.get(key)?.as_str()
}

fn node_path(nodes: &[Value], node: usize) -> Option<String> {
    let own = nodes.get(node)?;
    let name = text(own, "name")?;
    // Nodes come after those around them.
    match own.get("parent").and_then(Value::as_u64).map(|parent| parent as usize) {
        Some(parent) if parent < node => Some(format!("{}/{name}", node_path(nodes, parent)?)),
        _ => Some(name.to_owned()),
    }
}

/// Shape, origin and usages in a line.
fn resource_words(resource: &Value) -> Option<String> {
    let desc = resource.get("desc")?;
    let shape = match (desc.get("Texture"), desc.get("Buffer")) {
        (Some(texture), _) => {
            let size = texture.get("size")?;
            let number = |value: &Value, key: &str| value.get(key)?.as_u64();
            format!(
                "{}x{}x{} {}, {} mips, {} samples",
                number(size, "width")?,
                number(size, "height")?,
                number(size, "depthOrArrayLayers")?,
                text(texture, "format")?,
                number(texture, "mip_levels")?,
                number(texture, "samples")?,
            )
        }
        (None, Some(buffer)) => format!("buffer of {} bytes", buffer.get("bytes")?.as_u64()?),
        (None, None) => return None,
    };
    let origin = match resource.get("origin")? {
        Value::String(origin) => origin.to_lowercase(),
        Value::Object(origin) => origin.keys().next()?.to_lowercase(),
        _ => return None,
    };
    let exported = if resource.get("exported")?.as_bool()? { ", exported" } else { "" };
    let usages = [text(resource, "texture_usage")?, text(resource, "buffer_usage")?].concat();
    let usages = if usages.is_empty() { "no usage".to_owned() } else { usages };
    Some(format!("{shape}, {origin}{exported}, {usages}"))
}

/// What is done with which part, what becomes of the earlier contents, and the version that is found or made.
fn access_words(access: &Value) -> Option<String> {
    let label = Access::deserialize(access.get("access")?).ok()?.label();
    let subresource = Subresource::deserialize(access.get("part")?).ok()?;
    let subresource = if subresource == Subresource::FULL {
        String::new()
    } else {
        format!(" of {}", subresource.to_string())
    };
    let version = access.get("version")?.as_u64()?;
    let contents = match access.get("contents")? {
        Value::Null => return Some(format!("{label}{subresource}, version {version}")),
        Value::String(contents) if contents == "Cover" => "covers",
        Value::String(_) => "keeps",
        _ => "clears",
    };
    Some(format!("{label}{subresource}, {contents}, makes version {}", version + 1))
}
