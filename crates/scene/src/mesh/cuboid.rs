//! Axis-aligned boxes.

use glam::{DVec2, DVec3};

use super::{Mesh, Vertex};

/// Returns the box between two corners. Texture coordinates are in metres, and tangents point along their u.
pub(super) fn cuboid(min: DVec3, max: DVec3) -> Mesh {
    let size = max - min;
    let (x, y, z) = (DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z);
    // The corner of each face and the edges along its u and against its v; u x v is the normal.
    let faces = [
        (min + z, x, y),
        (min + x, -x, y),
        (min + x + z, -z, y),
        (min, z, y),
        (min + y + z, x, -z),
        (min, x, z),
    ];
    // A box without thickness has no sides.
    let faces: Vec<_> = faces.into_iter().filter(|(_, u, v)| u.cross(*v) != DVec3::ZERO).collect();
    let vertices = faces.iter().flat_map(|&(corner, edge_u, edge_v)| face(corner, edge_u, edge_v));
    let indices = (0..faces.len() as u32).flat_map(|face| [0, 1, 2, 1, 3, 2].map(|vertex| face * 4 + vertex));
    Mesh::new("box", vertices.collect(), indices.collect())
}

/// Returns the four vertices of a parallelogram, row by row.
fn face(corner: DVec3, edge_u: DVec3, edge_v: DVec3) -> [Vertex; 4] {
    let normal = edge_u.cross(edge_v).normalize_or(DVec3::Y);
    let tangent = edge_u.normalize_or(normal.any_orthonormal_vector());
    [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)].map(|(u, v)| Vertex {
        position: (corner + edge_u * u + edge_v * v).as_vec3().to_array(),
        normal: normal.as_vec3().normalize_or(glam::Vec3::Y).to_array(),
        tangent: tangent.as_vec3().normalize_or(glam::Vec3::X).extend(1.0).to_array(),
        uv0: DVec2::new(u * edge_u.length(), (1.0 - v) * edge_v.length()).as_vec2().to_array(),
        ..Vertex::default()
    })
}
