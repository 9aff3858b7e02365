//! The JSON Schema of pipeline files, for editors and other tools.

use serde_json::{Value, json};

use crate::nodes::Nodes;

/// Returns the schema of a pipeline file that names these kinds of nodes. RON's maps and records are its objects.
pub fn schema(nodes: &Nodes) -> Value {
    let text = || json!({ "type": "string" });
    let texts = || json!({ "type": "array", "items": text() });
    let values = || json!({ "type": "object" });
    let map = |of: Value| json!({ "type": "object", "additionalProperties": of });
    let output = || json!({ "anyOf": [text(), texts()] });
    let kinds: Vec<Value> = nodes.kinds().iter().map(|kind| kind.schema()).collect();
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A pipeline of Shadowgraph",
        "type": "object",
        "properties": {
            "about": text(),
            "include": texts(),
            "parameters": values(),
            "tiers": map(values()),
            "tier_for": map(text()),
            "nodes": { "type": "array", "items": { "anyOf": kinds } },
            "outputs": {
                "type": "object",
                "properties": { "picture": output(), "light": output(), "depth": output() },
                "additionalProperties": false,
            },
        },
        "required": ["nodes"],
        "additionalProperties": false,
    })
}
