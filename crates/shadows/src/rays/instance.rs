//! Meshes placed in the world.

use glam::{Affine3A, DAffine3, DMat3, DVec3, Vec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;

use super::gpu_structs::{RAY_NONE, RayInstance, rows};
use super::keys::{RayMeshKey, RaySurfacesKey};
use super::mesh::MAX_COORDINATE_M;

/// Margin around boxes, per metre of the ray's and the scene's coordinates: 64 times the rounding error of f32. The [module](super) has
/// the derivation.
pub(crate) const BOX_MARGIN: f32 = 1.0 / (1 << 18) as f32;

/// Largest number in an inverse: the product of distances and inverse directions still fits into f32.
const MAX_INVERSE: f32 = 1e8;

/// A mesh placed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// The mesh.
    pub mesh: RayMeshKey,
    /// The surfaces of the mesh's triangles; `None` if all are opaque.
    pub surfaces: Option<RaySurfacesKey>,
    /// The transform, absolute, in f64.
    pub world_from_mesh: DAffine3,
}

/// An instance as rays see it.
pub(crate) struct Placement {
    /// What the shader reads.
    pub(crate) packed: RayInstance,
    /// Its box, relative to the origin; `None` if it cannot be hit: empty, not finite or farther than 1e9 m away.
    pub(crate) bounds: Option<Aabb>,
    /// An upper bound of the terms that coordinates of its corners are sums of, metres.
    pub(crate) reach_m: f32,
}

impl Placement {
    /// Places a mesh whose tree has `root` and the box `local`. The transform is rounded as for drawing: the origin is subtracted in f64.
    pub(crate) fn new(world_from_mesh: &DAffine3, origin_world: DVec3, root: u32, local: &Aabb) -> Self {
        let relative =
            DAffine3 { translation: world_from_mesh.translation - origin_world, ..*world_from_mesh };
        let world_from_mesh = relative.as_affine3a();
        let packed = RayInstance {
            world_from_mesh: rows(&world_from_mesh),
            root,
            first_surface: RAY_NONE,
            ..RayInstance::default()
        };
        let outside = Self { packed, bounds: None, reach_m: 0.0 };
        if !local.valid() || !world_from_mesh.is_finite() {
            return outside;
        }
        let half = (local.max - local.min) * 0.5;
        let (center, half) =
            (world_from_mesh.transform_point3a(local.min + half), absolute(&world_from_mesh, half));
        let farthest = local.min.abs().max(local.max.abs());
        let reach = absolute(&world_from_mesh, farthest) + world_from_mesh.translation.abs();
        let reach_m = reach.max_element();
        if reach_m.is_nan() || reach_m > MAX_COORDINATE_M || reach_m == 0.0 {
            return outside;
        }
        let (mesh_from_world, margin) = inverse(&world_from_mesh).unwrap_or_else(|| {
            // A mesh flattened to a plane or a line: its boxes contain every ray, so all of its triangles are tested.
            let everything = 2.0 * farthest.max_element() / reach_m;
            ([Vec4::ZERO; 3], Vec3::splat(everything.min(MAX_INVERSE)))
        });
        let packed = RayInstance { mesh_from_world, margin, ..packed };
        Self { packed, bounds: Some(Aabb { min: center - half, max: center + half }), reach_m }
    }
}

/// Returns the matrix of absolute values times a vector.
fn absolute(matrix: &Affine3A, vector: Vec3A) -> Vec3A {
    let linear = matrix.matrix3;
    linear.x_axis.abs() * vector.x + linear.y_axis.abs() * vector.y + linear.z_axis.abs() * vector.z
}

/// Returns the rows of the inverse, computed in f64, and the margin around boxes per metre; `None` if there is no inverse.
fn inverse(world_from_mesh: &Affine3A) -> Option<([Vec4; 3], Vec3)> {
    let (linear, offset) = (world_from_mesh.matrix3, world_from_mesh.translation.as_dvec3());
    let rows = DMat3::from_cols(linear.x_axis.as_dvec3(), linear.y_axis.as_dvec3(), linear.z_axis.as_dvec3())
        .inverse()
        .transpose();
    let rows = [rows.x_axis, rows.y_axis, rows.z_axis].map(|row| row.extend(-row.dot(offset)).as_vec4());
    let sums = Vec3::from(rows.map(|row| row.truncate().abs().element_sum()));
    let usable = rows.iter().all(|row| row.is_finite()) && sums.max_element() < MAX_INVERSE;
    usable.then_some((rows, sums * BOX_MARGIN))
}
