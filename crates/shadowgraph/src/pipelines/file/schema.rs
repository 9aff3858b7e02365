//! The JSON Schema of pipeline files, for editors and other tools.

use serde_json::{Value, json};

use crate::nodes::kind::NodeKind;
use crate::nodes::registry::Nodes;

/// Returns the schema of a pipeline file that uses these kinds of nodes. RON maps and structs are objects in it.
pub fn schema(nodes: &Nodes) -> Value {
    let text = || json!({ "type": "string" });
    let output = || json!({ "anyOf": [text(), { "type": "array", "items": text() }] });
    let kinds: Vec<Value> = nodes.kinds().iter().map(NodeKind::schema).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "Shadowgraph pipeline",
        "type": "object",
        "properties": {
            "about": text(),
            "parameters": { "type": "object" },
            "nodes": { "type": "array", "items": { "anyOf": kinds } },
            "outputs": {
                "type": "object",
                "properties": { "image": output(), "light": output(), "depth": output() },
                "additionalProperties": false,
            },
        },
        "required": ["nodes"],
        "additionalProperties": false,
    })
}
