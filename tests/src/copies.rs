//! A file with many copies of a box.

use glam::DVec3;
use serde_json::json;
use shadowgraph::scene::Mesh;

use crate::gltf_file::File;

/// Copies in a row.
const ROW: usize = 1000;
/// Distance between copies, metres.
const SPACING_M: f32 = 2.0;

/// Returns a file with one box, and `count` copies of it by EXT_mesh_gpu_instancing.
#[must_use]
pub fn copies(count: usize) -> File {
    let mut file = File::new(json!([{"mesh": 0}]), 1);
    let mesh = Mesh::cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    let vectors = |vector: fn(&shadowgraph::scene::Vertex) -> [f32; 3]| {
        mesh.vertices.iter().flat_map(vector).collect::<Vec<f32>>()
    };
    let positions = file.floats("VEC3", 3, &vectors(|vertex| vertex.position));
    let normals = file.floats("VEC3", 3, &vectors(|vertex| vertex.normal));
    let bytes: Vec<u8> = mesh.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
    let indices = file.accessor(&bytes, 5125, "SCALAR", mesh.indices.len());
    let attributes = json!({"POSITION": positions, "NORMAL": normals});
    file.add_mesh(json!({"primitives": [{"attributes": attributes, "indices": indices}]}));
    let place = |copy: usize| [(copy % ROW) as f32 * SPACING_M, 0.0, (copy / ROW) as f32 * SPACING_M];
    let translations: Vec<f32> = (0..count).flat_map(place).collect();
    let translations = file.floats("VEC3", 3, &translations);
    file.json["nodes"][0]["extensions"] =
        json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": translations}}});
    file.require("EXT_mesh_gpu_instancing");
    file
}
