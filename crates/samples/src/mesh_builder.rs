//! A mesh builder: patches of positions, normals and texture coordinates.

use std::ops::RangeInclusive;

use glam::{DAffine3, DMat3, DVec2, DVec3};

use shadowgraph_scene::{Mesh, Vertex};

/// Step of the finite differences for normals, in parameter units.
const DERIVATIVE_STEP: f64 = 1e-4;

/// A point of a surface: its position, its normal and its texture coordinates.
#[derive(Clone, Copy)]
pub(crate) struct SurfacePoint {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) uv: DVec2,
}

/// A mesh under construction, in f64 until [`MeshBuilder::finish`].
#[derive(Clone, Default)]
pub(crate) struct MeshBuilder {
    points: Vec<SurfacePoint>,
    indices: Vec<u32>,
}

impl MeshBuilder {
    /// Adds a patch of `columns` x `rows` cells; `point` is evaluated at (u, v), both 0 to 1.
    pub(crate) fn grid(&mut self, columns: u32, rows: u32, point: impl Fn(f64, f64) -> SurfacePoint) {
        let first = self.points.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let u = f64::from(column) / f64::from(columns);
                let v = f64::from(row) / f64::from(rows);
                self.points.push(point(u, v));
            }
        }
        let stride = columns + 1;
        for row in 0..rows {
            for column in 0..columns {
                let corner = first + row * stride + column;
                let (right, below) = (corner + 1, corner + stride);
                self.triangle([corner, right, below]);
                self.triangle([right, below + 1, below]);
            }
        }
    }

    /// Adds a patch whose normals are computed from the derivatives of its positions. The normal is d/du x d/dv.
    pub(crate) fn surface(&mut self, columns: u32, rows: u32, position: impl Fn(f64, f64) -> DVec3) {
        let h = DERIVATIVE_STEP;
        self.grid(columns, rows, |u, v| {
            let along_u = position(u + h, v) - position(u - h, v);
            let along_v = position(u, v + h) - position(u, v - h);
            SurfacePoint {
                position: position(u, v),
                normal: along_u.cross(along_v).normalize_or(DVec3::Y),
                uv: DVec2::new(u, v),
            }
        });
    }

    /// Adds a flat parallelogram at `corner` spanned by two edges, its uv in metres. It faces
    /// `edge_u x edge_v`.
    pub(crate) fn parallelogram(&mut self, corner: DVec3, edge_u: DVec3, edge_v: DVec3) {
        let normal = edge_u.cross(edge_v).normalize_or(DVec3::Y);
        let (length_u, length_v) = (edge_u.length(), edge_v.length());
        self.grid(1, 1, |u, v| SurfacePoint {
            position: corner + edge_u * u + edge_v * v,
            normal,
            uv: DVec2::new(u * length_u, (1.0 - v) * length_v),
        });
    }

    /// Adds another mesh with a rigid or scaling transform.
    pub(crate) fn append(&mut self, other: &MeshBuilder, local_from_other: DAffine3) {
        let first = self.points.len() as u32;
        let normals: DMat3 = local_from_other.matrix3.inverse().transpose();
        self.points.extend(other.points.iter().map(|point| SurfacePoint {
            position: local_from_other.transform_point3(point.position),
            normal: (normals * point.normal).normalize_or(DVec3::Y),
            uv: point.uv,
        }));
        self.indices.extend(other.indices.iter().map(|index| first + index));
    }

    /// Adds another mesh, translated by `offset`.
    pub(crate) fn append_translated(&mut self, other: &MeshBuilder, offset: DVec3) {
        self.append(other, DAffine3::from_translation(offset));
    }

    /// Adds a triangle with the winding that agrees with its normals; drops it if it has no area.
    fn triangle(&mut self, [a, b, c]: [u32; 3]) {
        let [pa, pb, pc] = [a, b, c].map(|index| self.points[index as usize]);
        let facing = (pb.position - pa.position).cross(pc.position - pa.position);
        if facing.length_squared() < 1e-18 {
            return;
        }
        let agrees = facing.dot(pa.normal + pb.normal + pc.normal) >= 0.0;
        self.indices.extend(if agrees { [a, b, c] } else { [a, c, b] });
    }

    /// Rounds to f32 and adds tangents.
    pub(crate) fn finish(self, name: &str) -> Mesh {
        let tangents = self.tangents();
        let vertices = self.points.iter().zip(tangents).map(|(point, tangent)| Vertex {
            position: point.position.as_vec3().to_array(),
            normal: point.normal.as_vec3().normalize_or(glam::Vec3::Y).to_array(),
            tangent,
            uv0: point.uv.as_vec2().to_array(),
            uv1: [0.0; 2],
            color: Vertex::WHITE,
        });
        Mesh::new(name, vertices.collect(), self.indices)
    }

    /// Returns the tangent of each vertex: the direction of increasing u, and the sign of the bitangent (as in glTF, the
    /// bitangent points to the top of the image, in the direction of decreasing v).
    fn tangents(&self) -> Vec<[f32; 4]> {
        let mut sums = vec![(DVec3::ZERO, DVec3::ZERO); self.points.len()];
        for corners in self.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| self.points[corners[k] as usize]);
            let (edge1, edge2) = (b.position - a.position, c.position - a.position);
            let (uv1, uv2) = (b.uv - a.uv, c.uv - a.uv);
            let area = uv1.perp_dot(uv2);
            if area.abs() < 1e-12 {
                continue;
            }
            let along_u = (edge1 * uv2.y - edge2 * uv1.y) / area;
            let along_v = (edge2 * uv1.x - edge1 * uv2.x) / area;
            for &corner in corners {
                sums[corner as usize].0 += along_u;
                sums[corner as usize].1 += along_v;
            }
        }
        let tangent = |(point, (along_u, along_v)): (&SurfacePoint, (DVec3, DVec3))| {
            let flat = along_u - point.normal * point.normal.dot(along_u);
            let tangent = flat.normalize_or(point.normal.any_orthonormal_vector());
            let side = if point.normal.cross(tangent).dot(along_v) > 0.0 { -1.0 } else { 1.0 };
            tangent.as_vec3().normalize_or(glam::Vec3::X).extend(side).to_array()
        };
        self.points.iter().zip(sums).map(tangent).collect()
    }
}

/// Returns a box between two corners, with uv in metres.
pub(crate) fn cuboid(min: DVec3, max: DVec3) -> MeshBuilder {
    let size = max - min;
    let (x, y, z) = (DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z);
    let mut shape = MeshBuilder::default();
    shape.parallelogram(min + z, x, y);
    shape.parallelogram(min + x, -x, y);
    shape.parallelogram(min + x + z, -z, y);
    shape.parallelogram(min, z, y);
    shape.parallelogram(min + y + z, x, -z);
    shape.parallelogram(min, x, z);
    shape
}

/// Returns a box of this size on the ground, centred above the origin.
pub(crate) fn box_on_ground(width: f64, height: f64, depth: f64) -> MeshBuilder {
    cuboid(DVec3::new(-width * 0.5, 0.0, -depth * 0.5), DVec3::new(width * 0.5, height, depth * 0.5))
}

/// Returns a square shaft over the heights `y`, which tapers from bottom to top and is closed at the top. Its half widths
/// are `half_bottom` and `half_top`.
pub(crate) fn tapered_shaft(y: RangeInclusive<f64>, half_bottom: f64, half_top: f64) -> MeshBuilder {
    let (bottom, top) = (*y.start(), *y.end());
    let mut side = MeshBuilder::default();
    let normal = DVec3::new(0.0, half_bottom - half_top, top - bottom).normalize_or(DVec3::Z);
    side.grid(1, 1, |u, v| {
        let half = half_bottom + (half_top - half_bottom) * v;
        let x = (u * 2.0 - 1.0) * half;
        SurfacePoint {
            position: DVec3::new(x, bottom + (top - bottom) * v, half),
            normal,
            uv: DVec2::new(x, bottom - (top - bottom) * v),
        }
    });
    let mut shape = MeshBuilder::default();
    for quarter in 0..4 {
        let rotation = DAffine3::from_rotation_y(f64::from(quarter) * std::f64::consts::FRAC_PI_2);
        shape.append(&side, rotation);
    }
    let lid = DVec3::new(-half_top, top, half_top);
    shape.parallelogram(lid, DVec3::X * half_top * 2.0, DVec3::NEG_Z * half_top * 2.0);
    shape
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuboid_equals_the_one_of_the_scene_crate() {
        let (min, max) = (DVec3::new(-1.0, 0.5, 2.0), DVec3::new(3.0, 0.75, 2.25));
        assert_eq!(cuboid(min, max).finish("box"), Mesh::cuboid(min, max));
    }
}
