//! Small glTF files built in code.

use std::path::PathBuf;

use serde_json::{Value, json};
use shadowgraph_scene::{Error, Scene, gltf};

/// A file in a temporary directory, with `data.bin` next to it.
pub(crate) struct File {
    pub(crate) directory: tempfile::TempDir,
    pub(crate) json: Value,
    pub(crate) bin: Vec<u8>,
}

impl File {
    /// Creates a scene of one indexed triangle: (0,0,0), (1,0,0), (0,1,0).
    pub(crate) fn triangle() -> Self {
        let mut file = Self::empty();
        let positions = file.view_f32(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        file.accessor(positions, 5126, 3, "VEC3");
        let indices = file.view(&[0, 0, 1, 0, 2, 0, 0, 0]);
        file.accessor(indices, 5123, 3, "SCALAR");
        file.json["meshes"] = json!([{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]);
        file.json["nodes"] = json!([{"mesh": 0}]);
        file.json["scenes"] = json!([{"nodes": [0]}]);
        file
    }

    /// Creates a file with only a version and an empty buffer.
    pub(crate) fn empty() -> Self {
        let json = json!({
            "asset": {"version": "2.0"},
            "buffers": [{"uri": "data.bin", "byteLength": 0}],
            "bufferViews": [],
            "accessors": [],
        });
        Self { directory: tempfile::tempdir().unwrap(), json, bin: Vec::new() }
    }

    /// Adds bytes to the buffer, and returns the index of their view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let view = json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()});
        self.bin.extend(bytes);
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        push(&mut self.json["bufferViews"], view)
    }

    /// Adds floats to the buffer, and returns the index of their view.
    pub(crate) fn view_f32(&mut self, values: &[f32]) -> usize {
        self.view(&values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<_>>())
    }

    /// Adds an accessor, and returns its index.
    pub(crate) fn accessor(&mut self, view: usize, component: u32, count: u64, kind: &str) -> usize {
        let accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": kind});
        push(&mut self.json["accessors"], accessor)
    }

    /// Adds an attribute of floats to the first primitive.
    pub(crate) fn attribute(&mut self, name: &str, kind: &str, values: &[f32]) {
        let width = ["SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|k| *k == kind).unwrap() + 1;
        let view = self.view_f32(values);
        let accessor = self.accessor(view, 5126, (values.len() / width) as u64, kind);
        self.json["meshes"][0]["primitives"][0]["attributes"][name] = json!(accessor);
    }

    /// Adds an accessor of floats, and returns its index.
    pub(crate) fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
        let view = self.view_f32(values);
        self.accessor(view, 5126, (values.len() / width) as u64, kind)
    }

    /// Adds an animation of one property of a node by keyframes, and returns its index.
    pub(crate) fn animate(&mut self, node: usize, path: &str, input: usize, output: usize) -> usize {
        let animation = json!({
            "channels": [{"sampler": 0, "target": {"node": node, "path": path}}],
            "samplers": [{"input": input, "output": output}],
        });
        if self.json.get("animations").is_none() {
            self.json["animations"] = json!([]);
        }
        push(&mut self.json["animations"], animation)
    }

    /// Writes the file and loads it.
    pub(crate) fn load(&self) -> Result<Scene, Error> {
        let path = self.directory.path().join("scene.gltf");
        std::fs::write(self.directory.path().join("data.bin"), &self.bin).unwrap();
        std::fs::write(&path, self.json.to_string()).unwrap();
        gltf::load(&path)
    }

    /// Returns the file as one GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0].as_object_mut().unwrap().remove("uri");
        let mut json = json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bin = self.bin.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let u32_bytes = |value: usize| u32::try_from(value).unwrap().to_le_bytes();
        let length = u32_bytes(12 + 8 + json.len() + 8 + bin.len());
        let header = [&b"glTF"[..], &u32_bytes(2), &length, &u32_bytes(json.len()), b"JSON"].concat();
        [&header, &json[..], &u32_bytes(bin.len()), b"BIN\0", &bin].concat()
    }

    /// Writes other bytes as the scene file and loads them.
    pub(crate) fn load_bytes(&self, bytes: &[u8]) -> Result<Scene, Error> {
        let path: PathBuf = self.directory.path().join("scene.glb");
        std::fs::write(&path, bytes).unwrap();
        gltf::load(&path)
    }
}

fn push(list: &mut Value, value: Value) -> usize {
    let list = list.as_array_mut().unwrap();
    list.push(value);
    list.len() - 1
}
