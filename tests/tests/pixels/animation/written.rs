//! Small animated glTF files built in code.

use serde_json::{Value, json};
use shadowgraph::scene::{Scene, gltf};

/// A file with one binary buffer.
pub(super) struct File {
    pub(super) json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// Creates a file with one scene that has these nodes; the first `roots` of them are roots.
    pub(super) fn new(nodes: Value, roots: usize) -> Self {
        let roots: Vec<usize> = (0..roots).collect();
        let json = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": roots}], "nodes": nodes,
            "buffers": [{}], "bufferViews": [], "accessors": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// Adds an accessor of floats, and returns its index.
    pub(super) fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, values.len() / width)
    }

    /// Adds an accessor, and returns its index.
    pub(super) fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        let view = push(&mut self.json["bufferViews"], view);
        let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds a channel to the only animation.
    pub(super) fn animate(&mut self, node: usize, path: &str, sampler: Value) {
        if self.json.get("animations").is_none() {
            self.json["animations"] = json!([{"channels": [], "samplers": []}]);
        }
        let sampler = push(&mut self.json["animations"][0]["samplers"], sampler);
        let channel = json!({"sampler": sampler, "target": {"node": node, "path": path}});
        push(&mut self.json["animations"][0]["channels"], channel);
    }

    /// Writes the file and loads it.
    pub(super) fn load(mut self) -> Scene {
        let directory = tempfile::tempdir().unwrap();
        self.json["buffers"][0] = json!({"uri": "data.bin", "byteLength": self.bytes.len()});
        std::fs::write(directory.path().join("data.bin"), &self.bytes).unwrap();
        let path = directory.path().join("scene.gltf");
        std::fs::write(&path, self.json.to_string()).unwrap();
        gltf::load(&path).unwrap()
    }
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
