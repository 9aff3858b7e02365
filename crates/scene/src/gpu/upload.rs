//! Buffers of vertices, indices and instance transforms.

use std::num::NonZeroU64;

use bytemuck::{Pod, Zeroable};
use glam::{DAffine3, DVec3, UVec4, Vec4};

use super::limits;
use crate::error::Error;
use crate::mesh::{Mesh, Vertex};
use crate::scene::Scene;

/// The maximum size of one write to the queue, bytes.
const CHUNK: usize = 4 << 20;

const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x2, 5 => Unorm8x4
];

/// Returns the layout of the vertex buffer: locations 0 to 5 are position, normal, tangent, both texture coordinates
/// and colour.
#[must_use]
pub fn vertex_layout() -> wgpu::VertexBufferLayout<'static> {
    wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

/// `Instance` of `draw.wgsl`: the rows of world_from_local of this frame and of the previous one, both relative to this
/// frame's origin.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct GpuInstance {
    row_x: Vec4,
    row_y: Vec4,
    row_z: Vec4,
    previous_row_x: Vec4,
    previous_row_y: Vec4,
    previous_row_z: Vec4,
    flags: UVec4,
}

impl GpuInstance {
    /// Converts the transform of an instance that does not move: subtracts the origin in f64, then rounds.
    pub(super) fn new(world_from_local: &DAffine3, origin_world: DVec3) -> Self {
        let [row_x, row_y, row_z] = rows(world_from_local, origin_world);
        let [previous_row_x, previous_row_y, previous_row_z] = [row_x, row_y, row_z];
        Self { row_x, row_y, row_z, previous_row_x, previous_row_y, previous_row_z, flags: UVec4::ZERO }
    }

    /// Converts all instances of a scene, in draw order.
    pub(super) fn all(scene: &Scene, order: &[u32], origin_world: DVec3) -> Vec<Self> {
        let instances = order.iter().filter_map(|&instance| scene.instances.get(instance as usize));
        instances.map(|instance| Self::new(&instance.world_from_local, origin_world)).collect()
    }
}

/// Returns the rows of an affine matrix, relative to the origin.
fn rows(world_from_local: &DAffine3, origin_world: DVec3) -> [Vec4; 3] {
    let rows = world_from_local.matrix3.transpose();
    let offset = world_from_local.translation - origin_world;
    [rows.x_axis.extend(offset.x), rows.y_axis.extend(offset.y), rows.z_axis.extend(offset.z)]
        .map(|row| row.as_vec4())
}

/// The range of a mesh in the buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct MeshRange {
    pub(super) first_index: u32,
    pub(super) index_count: u32,
    pub(super) base_vertex: i32,
}

/// The buffers of a scene's meshes.
pub(super) struct Geometry {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    pub(super) ranges: Vec<MeshRange>,
}

impl Geometry {
    /// Uploads all meshes.
    ///
    /// # Errors
    ///
    /// The meshes are larger than the device allows.
    pub(super) fn new(device: &wgpu::Device, queue: &wgpu::Queue, meshes: &[Mesh]) -> Result<Self, Error> {
        let (ranges, vertex_count, index_count) = ranges(meshes)?;
        let (vertex_size, index_size) = (size_of::<Vertex>() as u64, size_of::<u32>() as u64);
        let (vertex_bytes, index_bytes) = (vertex_count * vertex_size, index_count * index_size);
        limits::buffer(&device.limits(), "the scene's vertices", vertex_bytes)?;
        limits::buffer(&device.limits(), "the scene's indices", index_bytes)?;
        let vertices = meshes.iter().map(|mesh| bytemuck::cast_slice(&mesh.vertices));
        let indices = meshes.iter().map(|mesh| bytemuck::cast_slice(&mesh.indices));
        use wgpu::BufferUsages as Usage;
        Ok(Self {
            vertices: buffer(device, queue, "vertices", Usage::VERTEX, vertex_size, vertex_bytes, vertices),
            indices: buffer(device, queue, "indices", Usage::INDEX, index_size, index_bytes, indices),
            ranges,
        })
    }
}

/// Returns the range of each mesh, and the total number of vertices and indices.
fn ranges(meshes: &[Mesh]) -> Result<(Vec<MeshRange>, u64, u64), Error> {
    let vertex_count = meshes.iter().map(|mesh| mesh.vertices.len() as u64).sum();
    let index_count = meshes.iter().map(|mesh| mesh.indices.len() as u64).sum();
    limits::addressable(vertex_count, index_count)?;
    let (mut first_vertex, mut first_index) = (0, 0);
    let range = |mesh: &Mesh| {
        let index_count = mesh.indices.len() as u32;
        let range = MeshRange { first_index, index_count, base_vertex: first_vertex };
        first_vertex += mesh.vertices.len() as i32;
        first_index += index_count;
        range
    };
    Ok((meshes.iter().map(range).collect(), vertex_count, index_count))
}

/// Creates a buffer of `bytes` bytes (at least `min_bytes`, since an empty buffer cannot be bound) and fills it with the data.
pub(super) fn buffer<'p>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    usage: wgpu::BufferUsages,
    min_bytes: u64,
    bytes: u64,
    data: impl IntoIterator<Item = &'p [u8]>,
) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.max(min_bytes),
        usage: usage | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    // Many small meshes share one write.
    let (mut offset, mut chunk) = (0, Vec::new());
    let mut flush = |chunk: &mut Vec<u8>| {
        queue.write_buffer(&buffer, offset, chunk);
        offset += chunk.len() as u64;
        chunk.clear();
    };
    for data in data {
        for piece in data.chunks(CHUNK) {
            if chunk.len() + piece.len() > CHUNK {
                flush(&mut chunk);
            }
            chunk.extend_from_slice(piece);
        }
    }
    flush(&mut chunk);
    buffer
}

/// Returns the binding type of a buffer without a dynamic offset.
pub(super) fn buffer_binding(
    ty: wgpu::BufferBindingType,
    min_binding_size: Option<NonZeroU64>,
) -> wgpu::BindingType {
    wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size }
}

/// Creates the layout of group 3.
pub(super) fn instance_layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let min_size = NonZeroU64::new(size_of::<GpuInstance>() as u64);
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("instances"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX,
            ty: buffer_binding(wgpu::BufferBindingType::Storage { read_only: true }, min_size),
            count: None,
        }],
    })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use std::mem::offset_of;

    use super::*;

    #[test]
    fn instances_have_the_layout_of_the_wgsl_struct() {
        let module = shadowgraph_shaders::compose("depth.wgsl", &[]).unwrap();
        let fields = [
            ("row_x", offset_of!(GpuInstance, row_x)),
            ("row_y", offset_of!(GpuInstance, row_y)),
            ("row_z", offset_of!(GpuInstance, row_z)),
            ("previous_row_x", offset_of!(GpuInstance, previous_row_x)),
            ("previous_row_y", offset_of!(GpuInstance, previous_row_y)),
            ("previous_row_z", offset_of!(GpuInstance, previous_row_z)),
            ("flags", offset_of!(GpuInstance, flags)),
        ];
        shadowgraph_shaders::layout::check(&module, "Instance", size_of::<GpuInstance>(), &fields).unwrap();
    }

    #[test]
    fn instances_far_from_the_world_origin_are_exact_relative_to_the_gpu_origin() {
        let world = DVec3::new(1.0e7 + 0.015_625, -3.0, 2.5);
        let origin = DVec3::new(1.0e7, 0.0, 0.0);
        let transform = DAffine3::from_rotation_y(0.5) * DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0));
        let instance = GpuInstance::new(&(DAffine3::from_translation(world) * transform), origin);
        assert_eq!([instance.row_x.w, instance.row_y.w, instance.row_z.w], [0.015_625, -3.0, 2.5]);
        let local = DVec3::new(0.3, -0.7, 1.9);
        let transformed = [instance.row_x, instance.row_y, instance.row_z]
            .map(|row| f64::from(row.truncate().dot(local.as_vec3())));
        assert!(DVec3::from(transformed).abs_diff_eq(transform.transform_point3(local), 1e-6));
    }

    #[test]
    fn vertex_attributes_have_the_offsets_of_the_struct() {
        let offsets = ATTRIBUTES.map(|attribute| attribute.offset as usize);
        let expected = [
            offset_of!(Vertex, position),
            offset_of!(Vertex, normal),
            offset_of!(Vertex, tangent),
            offset_of!(Vertex, uv0),
            offset_of!(Vertex, uv1),
            offset_of!(Vertex, color),
        ];
        assert_eq!(offsets, expected);
        assert_eq!(vertex_layout().array_stride, 60);
    }

    #[test]
    fn meshes_are_consecutive_in_the_buffers() {
        let mesh =
            |vertices, indices: &[u32]| Mesh::new("", vec![Vertex::default(); vertices], indices.to_vec());
        let (ranges, vertices, indices) =
            ranges(&[mesh(3, &[0, 1, 2]), mesh(4, &[0, 1, 2, 2, 1, 3])]).unwrap();
        assert_eq!((vertices, indices), (7, 9));
        assert_eq!(ranges[1], MeshRange { first_index: 3, index_count: 6, base_vertex: 3 });
    }
}
