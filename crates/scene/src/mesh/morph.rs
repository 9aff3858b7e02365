//! Morph targets: displacements of the vertices of a mesh.

use bytemuck::{Pod, Zeroable};
use glam::DVec3;

use crate::bounds::Aabb;

/// The displacement of a vertex at weight 1, 36 bytes, as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MorphDelta {
    /// Added to the position, metres.
    pub position: [f32; 3],
    /// Added to the normal.
    pub normal: [f32; 3],
    /// Added to the direction of the tangent.
    pub tangent: [f32; 3],
}

/// The displacements of all vertices of a mesh; a weight says how much of them is added.
#[derive(Clone, Debug, PartialEq)]
pub struct MorphTarget {
    deltas: Vec<MorphDelta>,
    bounds: Aabb,
}

impl MorphTarget {
    /// Creates a target from the displacement of each vertex.
    #[must_use]
    pub fn new(deltas: Vec<MorphDelta>) -> Self {
        let positions = deltas.iter().map(|delta| DVec3::from(delta.position.map(f64::from)));
        let bounds = Aabb::from_points(positions);
        Self { deltas, bounds }
    }

    /// Returns the displacement of each vertex.
    #[must_use]
    pub fn deltas(&self) -> &[MorphDelta] {
        &self.deltas
    }

    /// Returns the bounds of the displacements of positions, metres.
    #[must_use]
    pub fn bounds(&self) -> &Aabb {
        &self.bounds
    }
}
