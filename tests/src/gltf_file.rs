//! Small glTF files built in code.
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

    /// Creates a file from its document and its buffer.
    pub fn from_parts(json: Value, bytes: Vec<u8>) -> Self {
        Self { json, bytes }
    }

    /// Returns the bytes of the buffer.
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// Adds bytes to the buffer, and returns the index of their view.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.append(bytes), "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    /// Adds bytes that an extension compresses to the buffer, and returns the index of their view. `extension` lacks the place of
    /// the bytes.
    pub fn compressed_view(
        &mut self,
        name: &str,
        bytes: &[u8],
        decoded_len: usize,
        mut extension: Value,
    ) -> usize {
        extension["buffer"] = json!(0);
        extension["byteOffset"] = json!(self.append(bytes));
        extension["byteLength"] = json!(bytes.len());
        let fallback = self.json["buffers"][1]["byteLength"].as_u64().unwrap_or(0);
        self.json["buffers"].as_array_mut().unwrap().truncate(1);
        let buffer =
            json!({"byteLength": fallback + decoded_len as u64, "extensions": {name: {"fallback": true}}});
        self.push("buffers", buffer);
        let mut view = json!({"buffer": 1, "byteOffset": fallback, "byteLength": decoded_len});
        if extension["mode"] == "ATTRIBUTES" {
            view["byteStride"] = extension["byteStride"].clone();
        }
        view["extensions"] = json!({name: extension});
        self.push("bufferViews", view)
    }

    /// Adds an accessor of floats, and returns its index.
    pub fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        self.accessor(&bytes, 5126, kind, values.len() / width)
    }

    /// Adds an accessor with its bytes, and returns its index.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessor_of(view, component, kind, count)
    }

    /// Adds an accessor of a view, and returns its index.
    pub fn accessor_of(&mut self, view: usize, component: u32, kind: &str, count: usize) -> usize {
        let accessor = self.bare_accessor(component, kind, count);
        self.json["accessors"][accessor]["bufferView"] = json!(view);
        accessor
    }

    /// Adds an accessor without a view, and returns its index.
    pub fn bare_accessor(&mut self, component: u32, kind: &str, count: usize) -> usize {
        self.push("accessors", json!({"componentType": component, "count": count, "type": kind}))
    }

    /// Adds a mesh.
    pub fn add_mesh(&mut self, mesh: Value) {
        self.push("meshes", mesh);
    }

    /// Adds a root, and returns its index.
    pub fn add_root(&mut self, node: Value) -> usize {
        let node = self.push("nodes", node);
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

    /// Adds an extension that the file uses and requires.
    pub fn require(&mut self, name: &str) {
        self.push("extensionsUsed", json!(name));
        self.push("extensionsRequired", json!(name));
    }

    /// Adds an element to a list of the document, and returns its index.
    pub fn push(&mut self, list: &str, value: Value) -> usize {
        if self.json.get(list).is_none() {
            self.json[list] = json!([]);
        }
        push(&mut self.json[list], value)
    }

    /// Returns the file as one GLB.
    pub fn glb(mut self) -> Vec<u8> {
        self.json["buffers"][0] = json!({"byteLength": self.bytes.len()});
        let mut json = self.json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        self.append(&[]);
        let u32_bytes = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
        let length = u32_bytes(12 + 8 + json.len() + 8 + self.bytes.len());
        let header = [&b"glTF"[..], &u32_bytes(2), &length, &u32_bytes(json.len()), b"JSON"].concat();
        [&header, &json[..], &u32_bytes(self.bytes.len()), b"BIN\0", &self.bytes].concat()
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

    /// Appends bytes at a multiple of 4, and returns their offset.
    fn append(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        offset
    }
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
