//! Facts of a dump, by name.

use super::Subject;
use crate::Error;
use crate::contents::DumpedContents;
use serde::Deserialize as _;
use serde_json::Value;
use shadowgraph_core::describe::bytes;
use shadowgraph_core::{Access, JSON_SCHEMA, Plan, Subresource};
use std::collections::BTreeMap;

/// Facts by subject and name; several if several things have the name.
pub(super) type Facts = BTreeMap<(Subject, String), Vec<String>>;

/// A frame read from its dump, to be compared with another.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dump {
    pub(super) facts: Facts,
    pub(super) contents: Option<DumpedContents>,
}

impl Dump {
    /// Reads a dump, as [`Plan::to_json`] writes it.
    ///
    /// # Errors
    /// [`Error::Dump`] if the text is not a dump, or has another schema version.
    pub fn from_json(json: &str) -> Result<Self, Error> {
        let dump = serde_json::from_str(json).map_err(|error| invalid_dump(&format!("not JSON: {error}")))?;
        Self::from_value(&dump)
    }

    pub(super) fn from_plan(plan: &Plan) -> Result<Self, Error> {
        Self::from_json(&plan.to_json().map_err(|error| invalid_dump(&error.to_string()))?)
    }

    fn from_value(dump: &Value) -> Result<Self, Error> {
        match dump.get("schema").and_then(Value::as_u64) {
            Some(schema) if schema == u64::from(JSON_SCHEMA) => {}
            Some(schema) => {
                return Err(invalid_dump(&format!(
                    "schema version {schema}, expected {JSON_SCHEMA}; write the dump again"
                )));
            }
            None => return Err(invalid_dump("missing field `schema`")),
        }
        let missing = || invalid_dump("a field is missing");
        let nodes = node_paths(dump).ok_or_else(missing)?;
        let path = |thing: &Value| path(thing, &nodes);
        let facts = Reader { dump, facts: Facts::new() }.read(&nodes).ok_or_else(missing)?;
        Ok(Self { facts, contents: DumpedContents::from_dump(dump, &path)? })
    }

    /// Adds the file of values that was written next to the dump (see [`ContentsRecorder`](crate::ContentsRecorder)).
    ///
    /// # Errors
    /// [`Error::Dump`] if the dump has no contents, or the file is not one of values.
    pub fn with_values(mut self, values: Vec<u8>) -> Result<Self, Error> {
        let contents = self.contents.as_mut().ok_or_else(|| invalid_dump("no field `contents`"))?;
        contents.set_values(values)?;
        Ok(self)
    }

    /// Returns whether the dump says what passes have written.
    pub fn has_contents(&self) -> bool {
        self.contents.is_some()
    }
}

fn invalid_dump(problem: &str) -> Error {
    Error::Dump { problem: problem.into() }
}

struct Reader<'d> {
    dump: &'d Value,
    facts: Facts,
}

impl Reader<'_> {
    /// Reads all facts; `None` if a field is missing.
    fn read(mut self, nodes: &[String]) -> Option<Facts> {
        self.summary()?;
        let plan = self.dump.get("plan")?;
        for path in nodes {
            self.add(Subject::Node, path.clone(), String::new());
        }
        let path = |thing: &Value| path(thing, nodes);
        let resources = plan.get("resources")?.as_array()?;
        for resource in resources {
            self.add(Subject::Resource, path(resource)?, describe_resource(resource)?);
        }
        for pass in plan.get("passes")?.as_array()? {
            let own = path(pass)?;
            for access in pass.get("accesses")?.as_array()? {
                let resource = resources.get(access.get("resource")?.as_u64()? as usize)?;
                self.add(Subject::Access, format!("{own} · {}", path(resource)?), describe_access(access)?);
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
            let value = if name.ends_with("bytes") { bytes(value) } else { value.to_string() };
            self.add(Subject::Summary, name.replace("_bytes", " memory"), value);
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

/// Returns the paths of all nodes.
fn node_paths(dump: &Value) -> Option<Vec<String>> {
    let nodes = dump.get("plan")?.get("nodes")?.as_array()?;
    (0..nodes.len()).map(|node| node_path(nodes, node)).collect()
}

/// Returns the path of a pass or a resource.
fn path(thing: &Value, nodes: &[String]) -> Option<String> {
    let name = text(thing, "name")?;
    Some(match thing.get("node").and_then(Value::as_u64) {
        Some(node) => format!("{}/{name}", nodes.get(node as usize)?),
        None => name.to_owned(),
    })
}

fn node_path(nodes: &[Value], node: usize) -> Option<String> {
    let own = nodes.get(node)?;
    let name = text(own, "name")?;
    // Nodes come after their parents.
    match own.get("parent").and_then(Value::as_u64).map(|parent| parent as usize) {
        Some(parent) if parent < node => Some(format!("{}/{name}", node_path(nodes, parent)?)),
        _ => Some(name.to_owned()),
    }
}

/// Describes shape, origin and usages in a line.
fn describe_resource(resource: &Value) -> Option<String> {
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

/// Describes the access, its subresource, what happens to the earlier contents, and the version that is read or written.
fn describe_access(access: &Value) -> Option<String> {
    let label = Access::deserialize(access.get("access")?).ok()?.label();
    let subresource = Subresource::deserialize(access.get("part")?).ok()?;
    let subresource =
        if subresource == Subresource::FULL { String::new() } else { format!(" of {}", subresource) };
    let version = access.get("version")?.as_u64()?;
    let contents = match access.get("contents")? {
        Value::Null => return Some(format!("{label}{subresource}, version {version}")),
        Value::String(contents) if contents == "Cover" => "overwrites",
        Value::String(_) => "preserves",
        _ => "clears",
    };
    Some(format!("{label}{subresource}, {contents}, makes version {}", version + 1))
}
