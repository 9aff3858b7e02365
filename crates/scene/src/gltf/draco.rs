//! Decoding of primitives with KHR_draco_mesh_compression.

use std::collections::BTreeMap;

use ::gltf::json;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use json::accessor::{ComponentType, Type};
use json::mesh::{Primitive, Semantic};
use json::validation::Checked;
use serde::Deserialize;

use super::accessors::{Accessor, Layout};
use super::buffers::Buffers;

pub(super) const NAME: &str = "KHR_draco_mesh_compression";

/// The maximum number of bytes of the attributes of one primitive.
const MAX_ATTRIBUTE_BYTES: u64 = 1 << 30;

/// The extension of a primitive, as in the file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "an object of compressed geometry")]
struct Compressed {
    buffer_view: usize,
    /// The id of each attribute in the compressed bytes.
    attributes: BTreeMap<Checked<Semantic>, u32>,
}

/// The decoded geometry of a primitive.
#[derive(Debug)]
pub(super) struct Geometry {
    mesh: Mesh,
    /// The accessor that each attribute replaces, and the id of the attribute in the mesh.
    attributes: Vec<(usize, u32)>,
}

impl Geometry {
    /// Decodes the geometry of a primitive; `None` if it is not compressed.
    ///
    /// # Errors
    /// The message says what is wrong with the compressed bytes, or which limit they exceed.
    pub(super) fn read(
        buffers: &Buffers<'_>,
        primitive: &Primitive,
        max_vertices: usize,
        max_indices: usize,
    ) -> Option<Result<Self, String>> {
        let compressed = primitive.extensions.as_ref()?.others.get(NAME)?;
        let geometry = Compressed::deserialize(compressed).map_err(|error| error.to_string());
        Some(geometry.and_then(|compressed| {
            let mesh = decode(buffers.view(compressed.buffer_view)?.bytes, max_vertices, max_indices)?;
            let accessor = |(semantic, id)| Some((primitive.attributes.get(&semantic)?.value(), id));
            Ok(Self { mesh, attributes: compressed.attributes.into_iter().filter_map(accessor).collect() })
        }))
    }

    /// Returns the vertices of the triangles, three for each.
    pub(super) fn indices(&self) -> Vec<u32> {
        self.mesh.faces().iter().flatten().map(|corner| corner.0).collect()
    }

    /// Returns the elements that replace those of an accessor, one for each vertex; `None` if they are not compressed.
    ///
    /// # Errors
    /// The message says what is wrong with the attribute and what is allowed.
    pub(super) fn accessor(
        &self,
        index: usize,
        normalized: bool,
    ) -> Option<Result<Accessor<'static>, String>> {
        let (_, id) = self.attributes.iter().find(|(accessor, _)| *accessor == index)?;
        let elements = match self.mesh.attribute_by_unique_id(*id) {
            Some(attribute) => elements(attribute, self.mesh.num_points(), normalized),
            None => Err("does not exist".to_owned()),
        };
        Some(elements.map_err(|reason| format!("{NAME}: attribute {id} {reason}")))
    }
}

fn decode(bytes: &[u8], max_vertices: usize, max_indices: usize) -> Result<Mesh, String> {
    let limits = DecodeLimits::default()
        .with_max_points(max_vertices as u64)
        .with_max_faces(max_indices as u64 / 3)
        .with_max_decoded_bytes(MAX_ATTRIBUTE_BYTES);
    let mut source = DecoderBuffer::new(bytes).with_limits(limits);
    let mut mesh = Mesh::new();
    MeshDecoder::new().decode(&mut source, &mut mesh).map_err(|error| error.to_string())?;
    match mesh.num_points() {
        count if count <= max_vertices => Ok(mesh),
        count => Err(format!(
            "has {count} vertices, more than the scene may still have (allowed: up to {max_vertices})"
        )),
    }
}

/// Copies the elements of an attribute in the order of the vertices.
fn elements(attribute: &PointAttribute, count: usize, normalized: bool) -> Result<Accessor<'static>, String> {
    let component = match attribute.data_type() {
        DataType::Int8 => ComponentType::I8,
        DataType::Uint8 => ComponentType::U8,
        DataType::Int16 => ComponentType::I16,
        DataType::Uint16 => ComponentType::U16,
        DataType::Uint32 => ComponentType::U32,
        DataType::Float32 => ComponentType::F32,
        other => return Err(format!("contains {other:?} (allowed: the component types of glTF)")),
    };
    let kind = match attribute.num_components() {
        1 => Type::Scalar,
        2 => Type::Vec2,
        3 => Type::Vec3,
        4 => Type::Vec4,
        other => return Err(format!("has {other} components per element (allowed: 1 to 4)")),
    };
    let layout = Layout { count, component, kind, normalized };
    let (size, source) = (layout.element_bytes(), attribute.buffer().data());
    let mut bytes = Vec::with_capacity(count * size);
    for vertex in (0..).take(count) {
        let value = attribute.mapped_index(PointIndex(vertex)).0 as usize;
        let element = value.checked_mul(size).and_then(|start| source.get(start..)?.get(..size));
        bytes.extend(element.ok_or_else(|| format!("has no element for vertex {vertex}"))?);
    }
    Ok(Accessor::packed(layout, bytes))
}
