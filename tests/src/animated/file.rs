//! Small animated glTF files built in code.
#![allow(clippy::unwrap_used, clippy::missing_panics_doc, clippy::must_use_candidate, reason = "tests")]

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use shadowgraph::scene::{Scene, gltf};

/// A file with one binary buffer.
#[derive(Clone, Debug)]
pub struct File {
    /// The document.
    pub json: Value,
    bytes: Vec<u8>,
}

impl File {
    /// Creates a file with one scene that has these nodes; the first `roots` of them are roots.
    pub fn new(nodes: Value, roots: usize) -> Self {
        let roots: Vec<usize> = (0..roots).collect();
        let json = json!({
            "asset": {"version": "2.0"}, "scenes": [{"nodes": roots}], "nodes": nodes,
            "buffers": [{}], "bufferViews": [], "accessors": [],
        });
        Self { json, bytes: Vec::new() }
    }

    /// Adds an accessor of floats, and returns its index.
    pub fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, values.len() / width)
    }

    /// Adds an accessor, and returns its index.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        self.bytes.extend(bytes);
        let view = push(&mut self.json["bufferViews"], view);
        let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds a mesh.
    pub fn add_mesh(&mut self, mesh: Value) {
        push(&mut self.json["meshes"], mesh);
    }

    /// Adds a root, and returns its index.
    pub fn add_root(&mut self, node: Value) -> usize {
        let node = push(&mut self.json["nodes"], node);
        push(&mut self.json["scenes"][0]["nodes"], json!(node));
        node
    }

    /// Adds a channel to the only animation.
    pub fn animate(&mut self, node: usize, path: &str, sampler: Value) {
        if self.json.get("animations").is_none() {
            self.json["animations"] = json!([{"channels": [], "samplers": []}]);
        }
        let sampler = push(&mut self.json["animations"][0]["samplers"], sampler);
        let channel = json!({"sampler": sampler, "target": {"node": node, "path": path}});
        push(&mut self.json["animations"][0]["channels"], channel);
    }

    /// Writes the file `scene.gltf` and its buffer into a directory, and returns its path.
    pub fn write(mut self, directory: &Path) -> PathBuf {
        self.json["buffers"][0] = json!({"uri": "data.bin", "byteLength": self.bytes.len()});
        std::fs::write(directory.join("data.bin"), &self.bytes).unwrap();
        let path = directory.join("scene.gltf");
        std::fs::write(&path, self.json.to_string()).unwrap();
        path
    }

    /// Writes the file and loads it.
    pub fn load(self) -> Scene {
        let directory = tempfile::tempdir().unwrap();
        gltf::load(&self.write(directory.path())).unwrap()
    }
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
