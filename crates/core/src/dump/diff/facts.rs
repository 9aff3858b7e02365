//! A dump as names and what is so of them.

use super::Subject;
use crate::dump::json::SCHEMA;
use crate::error::Error;
use serde_json::Value;
use std::collections::BTreeMap;

/// By subject and name: how it is; several where several have the name.
pub(super) type Facts = BTreeMap<(Subject, String), Vec<String>>;

/// Reads a dump; `which` of two it is, is for the error.
pub(super) fn facts(json: &str, which: &str) -> Result<Facts, Error> {
    let dump: Value =
        serde_json::from_str(json).map_err(|error| no_dump(which, &format!("it is not JSON: {error}")))?;
    match dump.get("schema").and_then(Value::as_u64) {
        Some(schema) if schema == u64::from(SCHEMA) => {}
        Some(schema) => {
            return Err(no_dump(
                which,
                &format!("it has schema {schema}, and {SCHEMA} is read: write it anew"),
            ));
        }
        None => return Err(no_dump(which, "it has no `schema`")),
    }
    Reader { dump: &dump, facts: Facts::new() }
        .read()
        .ok_or_else(|| no_dump(which, "a part of it is missing"))
}

fn no_dump(which: &str, problem: &str) -> Error {
    Error::Dump { problem: format!("{which}: {problem}") }
}

struct Reader<'d> {
    dump: &'d Value,
    facts: Facts,
}

impl Reader<'_> {
    /// `None` where a field is missing.
    fn read(mut self) -> Option<Facts> {
        let plan = self.dump.get("plan")?;
        let nodes = plan.get("nodes")?.as_array()?;
        let paths: Vec<String> =
            (0..nodes.len()).map(|node| node_path(nodes, node)).collect::<Option<_>>()?;
        for path in &paths {
            self.add(Subject::Node, path.clone(), String::new());
        }
        for pass in plan.get("passes")?.as_array()? {
            let name = text(pass, "name")?;
            let path = match pass.get("node").and_then(Value::as_u64) {
                Some(node) => format!("{}/{name}", paths.get(node as usize)?),
                None => name.to_owned(),
            };
            let kept = if pass.get("keep")?.as_bool()? { ", kept" } else { "" };
            self.add(Subject::Pass, path, format!("{}{kept}", text(pass, "kind")?.to_lowercase()));
        }
        for resource in plan.get("resources")?.as_array()? {
            self.add(Subject::Resource, text(resource, "name")?.to_owned(), resource_words(resource)?);
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
