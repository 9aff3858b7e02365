//! The vertex and index buffers of meshes.

use std::ops::Range;

use super::element_buffer::ElementBuffer;
use super::numbers::Numbers;
use crate::error::Error;
use crate::keys::MeshKey;
use crate::mesh::{Mesh, Vertex};
use crate::scene::Scene;

const ATTRIBUTES: [wgpu::VertexAttribute; 6] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2, 4 => Float32x2, 5 => Unorm16x4
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

/// Returns the layout of a second vertex buffer: location 6 is the position in the previous frame, in the space of the instance.
#[must_use]
pub fn previous_vertex_layout() -> wgpu::VertexBufferLayout<'static> {
    const POSITION: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![6 => Float32x3];
    wgpu::VertexBufferLayout { attributes: &POSITION, ..vertex_layout() }
}

/// The ranges of a mesh in the buffers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct MeshRanges {
    vertices: Range<u64>,
    indices: Range<u64>,
    /// Changes with the mesh.
    pub(super) version: u64,
}

impl MeshRanges {
    /// Returns the indices, and the base vertex of a draw.
    pub(super) fn draw(&self) -> (Range<u32>, i32) {
        (self.indices.start as u32..self.indices.end as u32, self.vertices.start as i32)
    }

    pub(super) fn vertex_count(&self) -> u64 {
        self.vertices.end - self.vertices.start
    }

    pub(super) fn triangle_count(&self) -> u32 {
        ((self.indices.end - self.indices.start) / 3) as u32
    }
}

/// The buffers of a scene's meshes.
pub(super) struct Geometry {
    vertices: ElementBuffer,
    indices: ElementBuffer,
    numbers: Numbers<MeshKey>,
    /// The ranges of each mesh, by number.
    ranges: Vec<MeshRanges>,
}

impl Geometry {
    /// Creates empty buffers that have the size of a scene's meshes.
    ///
    /// # Errors
    /// The meshes are larger than the device allows.
    pub(super) fn new(device: &wgpu::Device, scene: &Scene) -> Result<Self, Error> {
        let vertex_count = scene.meshes().map(|(_, mesh)| mesh.vertices.len() as u64).sum();
        let index_count = scene.meshes().map(|(_, mesh)| mesh.indices.len() as u64).sum();
        use wgpu::BufferUsages as Usage;
        // The base vertex is signed, and indices have 32 bits.
        let vertex = (size_of::<Vertex>() as u64, i32::MAX as u64);
        let index = (size_of::<u32>() as u64, u64::from(u32::MAX));
        Ok(Self {
            vertices: ElementBuffer::new(device, ("vertices", Usage::VERTEX), vertex, vertex_count)?,
            indices: ElementBuffer::new(device, ("indices", Usage::INDEX), index, index_count)?,
            numbers: Numbers::default(),
            ranges: Vec::new(),
        })
    }

    /// Returns the number of a mesh.
    pub(super) fn number(&self, key: MeshKey) -> Option<u32> {
        self.numbers.get(key)
    }

    /// Returns the ranges of a mesh by its number.
    pub(super) fn ranges(&self, number: u32) -> Option<&MeshRanges> {
        self.ranges.get(number as usize)
    }

    /// Uploads an inserted or replaced mesh, or frees a removed one.
    ///
    /// # Errors
    /// The meshes are larger than the device allows.
    pub(super) fn update(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        key: MeshKey,
        mesh: Option<&Mesh>,
        version: u64,
    ) -> Result<(), Error> {
        let previous = self.numbers.get(key).map(|number| std::mem::take(&mut self.ranges[number as usize]));
        if let Some(MeshRanges { vertices, indices, .. }) = previous {
            self.vertices.free(vertices);
            self.indices.free(indices);
        }
        let Some(mesh) = mesh else {
            self.numbers.remove(key);
            return Ok(());
        };
        let vertices = self.vertices.allocate(device, queue, mesh.vertices.len() as u64)?;
        self.vertices.write(queue, vertices.start, bytemuck::cast_slice(&mesh.vertices));
        let number = self.numbers.insert(key) as usize;
        if number == self.ranges.len() {
            self.ranges.push(MeshRanges::default());
        }
        self.ranges[number] = MeshRanges { vertices, indices: 0..0, version };
        let indices = self.indices.allocate(device, queue, mesh.indices.len() as u64)?;
        self.indices.write(queue, indices.start, bytemuck::cast_slice(&mesh.indices));
        self.ranges[number].indices = indices;
        Ok(())
    }

    /// Returns the size of the buffers, bytes.
    #[cfg(test)]
    pub(super) fn bytes(&self) -> u64 {
        self.vertices.buffer.size() + self.indices.buffer.size()
    }

    /// Sends pending writes to the queue.
    pub(super) fn flush(&mut self, queue: &wgpu::Queue) {
        self.vertices.flush(queue);
        self.indices.flush(queue);
    }

    /// Sets the vertex buffers of a pass for meshes that are not deformed: 0 has their vertices, and 1 too.
    pub(super) fn set_vertices(&self, pass: &mut wgpu::RenderPass<'_>) {
        for slot in 0..2 {
            pass.set_vertex_buffer(slot, self.vertices.buffer.slice(..));
        }
    }

    /// Sets the index buffer of a pass.
    pub(super) fn set_indices(&self, pass: &mut wgpu::RenderPass<'_>) {
        pass.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint32);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use std::mem::offset_of;

    use super::*;

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
        assert_eq!(vertex_layout().array_stride, 64);
    }

    #[test]
    fn meshes_are_consecutive_in_the_buffers_and_reuse_the_ranges_of_removed_ones() {
        let mesh =
            |vertices, indices: &[u32]| Mesh::new("", vec![Vertex::default(); vertices], indices.to_vec());
        let gpu = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let mut scene = Scene::default();
        let small = scene.insert_mesh(mesh(3, &[0, 1, 2]));
        let large = scene.insert_mesh(mesh(4, &[0, 1, 2, 2, 1, 3]));
        let mut geometry = Geometry::new(&gpu.0, &scene).unwrap();
        for (key, mesh) in scene.meshes() {
            geometry.update((&gpu.0, &gpu.1), key, Some(mesh), 0).unwrap();
        }
        let draw = |geometry: &Geometry, key| geometry.ranges(geometry.number(key).unwrap()).unwrap().draw();
        assert_eq!((draw(&geometry, small), draw(&geometry, large)), ((0..3, 0), (3..9, 3)));
        geometry.update((&gpu.0, &gpu.1), small, None, 1).unwrap();
        assert_eq!(geometry.number(small), None);
        let other = scene.insert_mesh(mesh(3, &[0, 1, 2]));
        geometry.update((&gpu.0, &gpu.1), other, scene.mesh(other), 2).unwrap();
        assert_eq!(draw(&geometry, other), (0..3, 0));
        assert_eq!(geometry.vertices.buffer.size(), 7 * 64);
    }
}
