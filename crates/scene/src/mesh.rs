//! Triangle meshes and their vertices.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::bounds::Aabb;

mod cuboid;
mod morph;
mod normals;
mod pose;
mod skin;
mod tangents;
#[cfg(test)]
mod tests;

pub use morph::{MorphDelta, MorphTarget};
pub use pose::MeshPose;
pub use skin::{Influence, SkinWeights};

/// A vertex, 64 bytes, as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Vertex {
    /// Metres, in the mesh's own space.
    pub position: [f32; 3],
    /// Unit length.
    pub normal: [f32; 3],
    /// Unit length, perpendicular to the normal; `w` is 1 or -1: bitangent = cross(normal, tangent) * w.
    pub tangent: [f32; 4],
    /// Texture coordinates 0, v downwards.
    pub uv0: [f32; 2],
    /// Texture coordinates 1, v downwards.
    pub uv1: [f32; 2],
    /// Linear RGBA, 65,535 is 1; multiplies the base colour.
    pub color: [u16; 4],
}

impl Vertex {
    /// The colour that leaves the base colour as it is.
    pub const WHITE: [u16; 4] = [u16::MAX; 4];
}

impl Default for Vertex {
    /// Returns a white vertex at the origin with its normal along +Z.
    fn default() -> Self {
        Self {
            position: [0.0; 3],
            normal: [0.0, 0.0, 1.0],
            tangent: [1.0, 0.0, 0.0, 1.0],
            uv0: [0.0; 2],
            uv1: [0.0; 2],
            color: Self::WHITE,
        }
    }
}

/// A triangle list with indices, drawn with one material.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The name in the file; empty if it has none.
    pub name: String,
    /// The vertices.
    pub vertices: Vec<Vertex>,
    /// Three per triangle, counter-clockwise seen from the front, each below `vertices.len()`.
    pub indices: Vec<u32>,
    /// Bounds of the vertices in the mesh's own space.
    pub bounds: Aabb,
    /// The joints that move each vertex, if a skin can move the mesh.
    pub skin: Option<SkinWeights>,
    /// The displacements that weights can add to the vertices.
    pub morph_targets: Vec<MorphTarget>,
}

impl Mesh {
    /// Creates a mesh without skin and morph targets, and computes its bounds.
    ///
    /// ```
    /// use shadowgraph_scene::{Mesh, Vertex};
    /// let corner = |x, y| Vertex { position: [x, y, 0.0], ..Vertex::default() };
    /// let mesh = Mesh::new("triangle", vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)], vec![0, 1, 2]);
    /// assert_eq!(mesh.bounds.max.x, 1.0);
    /// ```
    #[must_use]
    pub fn new(name: impl Into<String>, vertices: Vec<Vertex>, indices: Vec<u32>) -> Self {
        let bounds = Aabb::from_points(vertices.iter().map(position));
        Self { name: name.into(), vertices, indices, bounds, skin: None, morph_targets: Vec::new() }
    }

    /// Creates a box from one corner to the opposite one, metres.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shadowgraph_scene::Mesh;
    /// let cube = Mesh::cuboid(DVec3::splat(-0.5), DVec3::splat(0.5));
    /// assert_eq!(cube.indices.len(), 6 * 2 * 3);
    /// ```
    #[must_use]
    pub fn cuboid(min: DVec3, max: DVec3) -> Self {
        cuboid::cuboid(min.min(max), min.max(max))
    }
}

fn position(vertex: &Vertex) -> DVec3 {
    DVec3::from(vertex.position.map(f64::from))
}
