//! Tangents for normal maps, after E. Lengyel's method, weighted by angle.

use glam::{DVec2, DVec3, Vec3, Vec4};

use super::normals::{angles, corners, unit};
use super::{Mesh, Vertex, position};

/// The sums of the directions of increasing u and v of the triangles around a vertex.
#[derive(Clone, Copy, Default)]
struct UvDirections {
    along_u: Vec3,
    along_v: Vec3,
}

impl Mesh {
    /// Computes all tangents from the normals and the texture coordinates of a set (0 or 1), which are
    /// first transformed by `uv_transform` (two rows: `uv' = M * (u, v, 1)`).
    ///
    /// Where the texture coordinates define no direction, an arbitrary one perpendicular to the normal is used.
    pub fn generate_tangents(&mut self, uv_set: u8, uv_transform: &[[f32; 3]; 2]) {
        let directions = self.uv_directions(uv_set, uv_transform);
        for (vertex, directions) in self.vertices.iter_mut().zip(directions) {
            vertex.tangent = tangent(vertex, directions).to_array();
        }
    }

    /// Normalizes the tangents and their signs, and computes those without a direction (zero or not finite) as
    /// [`generate_tangents`](Self::generate_tangents) does. Returns the number of computed ones.
    pub fn repair_tangents(&mut self, uv_set: u8, uv_transform: &[[f32; 3]; 2]) -> usize {
        let mut invalid = Vec::new();
        for (i, vertex) in self.vertices.iter_mut().enumerate() {
            let [x, y, z, w] = vertex.tangent;
            match unit(Vec3::new(x, y, z)) {
                Some(tangent) => vertex.tangent = tangent.extend(if w < 0.0 { -1.0 } else { 1.0 }).to_array(),
                None => invalid.push(i),
            }
        }
        if !invalid.is_empty() {
            let directions = self.uv_directions(uv_set, uv_transform);
            for i in &invalid {
                if let (Some(vertex), Some(directions)) = (self.vertices.get_mut(*i), directions.get(*i)) {
                    vertex.tangent = tangent(vertex, *directions).to_array();
                }
            }
        }
        invalid.len()
    }

    /// Gives every vertex an arbitrary tangent perpendicular to its normal, for meshes without a normal map.
    pub fn arbitrary_tangents(&mut self) {
        for vertex in &mut self.vertices {
            vertex.tangent = tangent(vertex, UvDirections::default()).to_array();
        }
    }

    fn uv_directions(&self, uv_set: u8, uv_transform: &[[f32; 3]; 2]) -> Vec<UvDirections> {
        let mut sums = vec![UvDirections::default(); self.vertices.len()];
        for indices in self.indices.as_chunks::<3>().0 {
            let Some(corners) = corners(*indices, &self.vertices) else { continue };
            let (along_u, along_v) = triangle_uv_directions(&corners, uv_set, uv_transform);
            for (index, angle) in indices.iter().zip(angles(&corners)) {
                if let Some(sum) = sums.get_mut(*index as usize) {
                    sum.along_u += (along_u * angle).as_vec3();
                    sum.along_v += (along_v * angle).as_vec3();
                }
            }
        }
        sums
    }
}

/// Returns the directions of increasing u and v on a triangle, unit length, or zero if there is none.
fn triangle_uv_directions(corners: &[Vertex; 3], uv_set: u8, uv_transform: &[[f32; 3]; 2]) -> (DVec3, DVec3) {
    let [a, b, c] = corners.each_ref().map(position);
    let [ta, tb, tc] = corners.each_ref().map(|vertex| {
        let [u, v] = if uv_set == 0 { vertex.uv0 } else { vertex.uv1 }.map(f64::from);
        let [x, y] = uv_transform.map(|[from_u, from_v, offset]| {
            f64::from(from_u) * u + f64::from(from_v) * v + f64::from(offset)
        });
        DVec2::new(x, y)
    });
    let (edge_b, edge_c, uv_b, uv_c) = (b - a, c - a, tb - ta, tc - ta);
    let sign = uv_b.perp_dot(uv_c).signum();
    let along_u = (edge_b * uv_c.y - edge_c * uv_b.y) * sign;
    let along_v = (edge_c * uv_b.x - edge_b * uv_c.x) * sign;
    (along_u.normalize_or_zero(), along_v.normalize_or_zero())
}

fn tangent(vertex: &Vertex, directions: UvDirections) -> Vec4 {
    let normal = Vec3::from(vertex.normal);
    let tangent = directions.along_u.reject_from_normalized(normal);
    match tangent.try_normalize() {
        None => normal.any_orthonormal_vector().extend(1.0),
        Some(tangent) => {
            // The green channel of a normal map points up, and v points down.
            let mirrored = normal.cross(tangent).dot(directions.along_v) > 0.0;
            tangent.extend(if mirrored { -1.0 } else { 1.0 })
        }
    }
}
