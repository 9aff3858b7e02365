//! Compressed and quantized geometry.

use draco_encoder::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute, PointIndex,
};
use meshoptimizer_rs::Workspace;
use meshoptimizer_rs::codec::{
    IndexEncoding, VertexEncoding, encode_filter_oct, encode_index_buffer, encode_vertex_buffer,
};
use serde_json::{Value, json};

use super::model::{Vase, with_primitive};
use crate::gltf_file::File;

/// Draco's edgebreaker, with quantized attributes.
pub(super) fn draco_edgebreaker() -> File {
    draco(1)
}

/// Draco's sequential encoding, with quantized attributes.
pub(super) fn draco_sequential() -> File {
    draco(0)
}

fn draco(method: i32) -> File {
    let mut file = with_primitive(|file, vase| {
        let view = file.view(&draco_bytes(vase, method));
        let count = vase.positions.len();
        let positions = file.bare_accessor(5126, "VEC3", count);
        let normals = file.bare_accessor(5126, "VEC3", count);
        let uvs = file.bare_accessor(5126, "VEC2", count);
        let indices = file.bare_accessor(5123, "SCALAR", vase.indices.len());
        json!({
            "attributes": {"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs},
            "indices": indices, "material": 1,
            "extensions": {"KHR_draco_mesh_compression": {
                "bufferView": view, "attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}}},
        })
    });
    file.require("KHR_draco_mesh_compression");
    file
}

fn draco_bytes(vase: &Vase, method: i32) -> Vec<u8> {
    let mut mesh = Mesh::new();
    let mut add = |kind, components: u8, values: &[f32]| {
        let mut attribute = PointAttribute::new();
        attribute.init(kind, components, DataType::Float32, false, values.len() / usize::from(components));
        let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
        attribute.buffer_mut().write(0, &bytes);
        mesh.add_attribute(attribute);
    };
    add(GeometryAttributeType::Position, 3, vase.positions.as_flattened());
    add(GeometryAttributeType::Normal, 3, vase.normals.as_flattened());
    add(GeometryAttributeType::TexCoord, 2, vase.uvs.as_flattened());
    let (triangles, _) = vase.indices.as_chunks::<3>();
    mesh.set_num_faces(triangles.len());
    for (face, corners) in (0..).zip(triangles) {
        mesh.set_face(FaceIndex(face), corners.map(|corner| PointIndex(corner.into())));
    }
    let mut options = EncoderOptions::new();
    options.set_encoding_method(method);
    for (attribute, bits) in [(0, 14), (1, 10), (2, 12)] {
        options.set_attribute_int(attribute, "quantization_bits", bits);
    }
    let (mut encoder, mut bytes) = (MeshEncoder::new(), EncoderBuffer::new());
    encoder.set_mesh(mesh);
    encoder.encode(&options, &mut bytes).unwrap();
    bytes.data().to_vec()
}

/// Version 0 of the codec of vertices, with filtered normals.
pub(super) fn meshopt() -> File {
    compressed_by("EXT_meshopt_compression", VertexEncoding::new(0, 0).unwrap())
}

/// Version 1 of the codec of vertices.
pub(super) fn meshopt_1() -> File {
    compressed_by("KHR_meshopt_compression", VertexEncoding::DEFAULT)
}

fn compressed_by(name: &str, encoding: VertexEncoding) -> File {
    let mut workspace = Workspace::default();
    let mut file = with_primitive(|file, vase| {
        let count = vase.positions.len();
        let mut add = |file: &mut File, bytes: &[u8], stride: usize, filter: &str| {
            let compressed = encode_vertex_buffer(bytes, count, stride, encoding, &mut workspace).unwrap();
            let extension =
                json!({"count": count, "byteStride": stride, "mode": "ATTRIBUTES", "filter": filter});
            file.compressed_view(name, &compressed, bytes.len(), extension)
        };
        let positions = add(file, &bytes(vase.positions.as_flattened()), 12, "NONE");
        let uvs = add(file, &bytes(vase.uvs.as_flattened()), 8, "NONE");
        let vectors: Vec<f32> = vase.normals.iter().flat_map(|[x, y, z]| [*x, *y, *z, 0.0]).collect();
        let filtered = encode_filter_oct(count, 8, 12, &vectors, &mut Workspace::default()).unwrap();
        let normals = add(file, &filtered, 8, "OCTAHEDRAL");
        let triangles: Vec<u32> = vase.indices.iter().map(|index| u32::from(*index)).collect();
        let compressed =
            encode_index_buffer(&triangles, IndexEncoding::DEFAULT, &mut Workspace::default()).unwrap();
        let extension = json!({"count": triangles.len(), "byteStride": 2, "mode": "TRIANGLES"});
        let indices = file.compressed_view(name, &compressed, triangles.len() * 2, extension);
        let normals = file.accessor_of(normals, 5122, "VEC3", count);
        file.json["accessors"][normals]["normalized"] = json!(true);
        json!({
            "attributes": {
                "POSITION": file.accessor_of(positions, 5126, "VEC3", count),
                "NORMAL": normals,
                "TEXCOORD_0": file.accessor_of(uvs, 5126, "VEC2", count),
            },
            "indices": file.accessor_of(indices, 5123, "SCALAR", triangles.len()), "material": 1,
        })
    });
    file.require(name);
    file
}

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|value| value.to_le_bytes()).collect()
}

/// Positions and texture coordinates of 16 bits, normals of 8 bits.
pub(super) fn quantized() -> File {
    const SCALE: f32 = 2.0;
    let mut file = with_primitive(|file, vase| {
        let count = vase.positions.len();
        let short = |value: f32| ((value * 32767.0).round() as i16).to_le_bytes();
        let positions: Vec<u8> = vase
            .positions
            .iter()
            .flat_map(|position| position.map(|x| short(x / SCALE)).into_iter().flatten().chain([0, 0]))
            .collect();
        let normals: Vec<u8> = vase
            .normals
            .iter()
            .flat_map(|normal| normal.map(|x| (x * 127.0).round() as i8 as u8).into_iter().chain([0]))
            .collect();
        let uvs: Vec<u8> = vase
            .uvs
            .iter()
            .flat_map(|uv| uv.map(|x| ((x * 65535.0).round() as u16).to_le_bytes()).into_iter().flatten())
            .collect();
        let mut add = |bytes: &[u8], component, kind: &str| {
            let accessor = file.accessor(bytes, component, kind, count);
            file.json["accessors"][accessor]["normalized"] = json!(true);
            let view = file.json["accessors"][accessor]["bufferView"].as_u64().unwrap() as usize;
            file.json["bufferViews"][view]["byteStride"] = json!(bytes.len() / count);
            accessor
        };
        let attributes = json!({
            "POSITION": add(&positions, 5122, "VEC3"),
            "NORMAL": add(&normals, 5120, "VEC3"),
            "TEXCOORD_0": add(&uvs, 5123, "VEC2"),
        });
        let indices: Vec<u8> = vase.indices.iter().flat_map(|index| index.to_le_bytes()).collect();
        let indices = file.accessor(&indices, 5123, "SCALAR", vase.indices.len());
        json!({"attributes": attributes, "indices": indices, "material": 1})
    });
    file.json["nodes"][1]["scale"] = Value::from(vec![SCALE; 3]);
    file.require("KHR_mesh_quantization");
    file
}
