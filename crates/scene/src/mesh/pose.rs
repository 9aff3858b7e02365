//! Deformation of meshes by skins and morph targets.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::{Mesh, MorphTarget, SkinWeights, Vertex, position};
use crate::bounds::Aabb;

/// Rounding errors of the GPU, relative to the largest coordinate.
const ROUNDING: f64 = 1e-5;

/// How a mesh is deformed: first by its morph targets, then by its skin.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPose {
    /// The transform from the space of the mesh to that of the instance, for each joint; empty without a skin. Joints that
    /// are missing do not move their vertices.
    pub joints: Arc<[DAffine3]>,
    /// The weights of the morph targets; those that are missing are 0.
    pub weights: Vec<f32>,
}

impl MeshPose {
    /// Returns whether all joints and weights are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.joints.iter().all(DAffine3::is_finite) && self.weights.iter().all(|weight| weight.is_finite())
    }

    /// Returns the transform of a joint.
    pub(crate) fn joint(&self, joint: u32) -> DAffine3 {
        self.joints.get(joint as usize).copied().unwrap_or(DAffine3::IDENTITY)
    }
}

impl Mesh {
    /// Returns bounds of the vertices in a pose, in the space of the instance. They may be larger than the vertices need: the union of
    /// the bounds of what each joint moves, extended by what morph targets can add.
    #[must_use]
    pub fn posed_bounds(&self, pose: &MeshPose) -> Aabb {
        let [low, high] = morph_extent(&self.morph_targets, &pose.weights);
        let morphed = |bounds: &Aabb| Aabb { min: bounds.min + low, max: bounds.max + high };
        let bounds = match self.skin.as_ref().filter(|_| !pose.joints.is_empty()) {
            None => morphed(&self.bounds),
            Some(skin) => (0..).zip(skin.joint_bounds()).fold(Aabb::EMPTY, |all, (joint, bounds)| {
                if bounds.is_empty() {
                    all
                } else {
                    all.union(&morphed(bounds).transformed(&pose.joint(joint)))
                }
            }),
        };
        if bounds.is_empty() {
            return bounds;
        }
        let error = DVec3::splat(bounds.min.abs().max(bounds.max.abs()).max_element() * ROUNDING);
        Aabb { min: bounds.min - error, max: bounds.max + error }
    }

    /// Returns the vertices in a pose, in the space of the instance: what the GPU computes, in f64.
    #[must_use]
    pub fn posed_vertices(&self, pose: &MeshPose) -> Vec<Vertex> {
        let skin = self.skin.as_ref().filter(|_| !pose.joints.is_empty());
        let posed = |(index, vertex): (usize, &Vertex)| {
            let [x, y, z, side] = vertex.tangent;
            let mut moved = [position(vertex), vector(vertex.normal), vector([x, y, z])];
            for (target, weight) in self.morph_targets.iter().zip(&pose.weights) {
                let Some(delta) = target.deltas().get(index) else { continue };
                for (moved, delta) in moved.iter_mut().zip([delta.position, delta.normal, delta.tangent]) {
                    *moved += vector(delta) * f64::from(*weight);
                }
            }
            let [mut position, mut normal, mut tangent] = moved;
            if let Some(transform) = skin.map(|skin| skin_transform(skin, index, pose)) {
                position = transform.transform_point3(position);
                normal = normal_matrix(&transform.matrix3) * normal;
                tangent = transform.matrix3 * tangent;
            }
            Vertex {
                position: position.as_vec3().to_array(),
                normal: normal.try_normalize().map_or(vertex.normal, |normal| normal.as_vec3().to_array()),
                tangent: match tangent.try_normalize() {
                    None => vertex.tangent,
                    Some(tangent) => tangent.as_vec3().extend(side).to_array(),
                },
                ..*vertex
            }
        };
        self.vertices.iter().enumerate().map(posed).collect()
    }
}

/// Returns the least and the largest displacement of any vertex by morph targets with these weights.
fn morph_extent(targets: &[MorphTarget], weights: &[f32]) -> [DVec3; 2] {
    let mut extent = [DVec3::ZERO; 2];
    for (target, weight) in targets.iter().zip(weights) {
        let bounds = target.bounds();
        if bounds.is_empty() {
            continue;
        }
        let ends = [bounds.min, bounds.max].map(|end| end * f64::from(*weight));
        extent[0] += ends[0].min(ends[1]);
        extent[1] += ends[0].max(ends[1]);
    }
    extent
}

/// Returns the weighted sum of the transforms of a vertex's joints.
fn skin_transform(skin: &SkinWeights, vertex: usize, pose: &MeshPose) -> DAffine3 {
    let mut sum = DAffine3::ZERO;
    for influence in skin.vertex(vertex).iter().filter(|influence| influence.weight > 0.0) {
        let (joint, weight) = (pose.joint(influence.joint), f64::from(influence.weight));
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
    }
    sum
}

/// Returns the matrix of normals, up to a positive factor: cofactors are defined where a scale is 0.
fn normal_matrix(matrix: &DMat3) -> DMat3 {
    let DMat3 { x_axis, y_axis, z_axis } = *matrix;
    let cofactors = DMat3::from_cols(y_axis.cross(z_axis), z_axis.cross(x_axis), x_axis.cross(y_axis));
    if matrix.determinant() < 0.0 { cofactors * -1.0 } else { cofactors }
}

fn vector(array: [f32; 3]) -> DVec3 {
    DVec3::from(array.map(f64::from))
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::mesh::{Influence, MorphDelta};
    use proptest::prelude::*;

    /// A point with its influences and the displacements of two morph targets.
    type Point = ([f32; 3], [(u32, f32); 4], [[f32; 3]; 2]);

    /// A mesh of single points.
    fn mesh(points: &[Point]) -> Mesh {
        let vertex = |position| Vertex { position, ..Vertex::default() };
        let vertices = points.iter().map(|(position, ..)| vertex(*position)).collect();
        let mut mesh = Mesh::new("points", vertices, Vec::new());
        let influences = points.iter().flat_map(|(_, influences, _)| influences);
        let influences = influences.map(|&(joint, weight)| Influence { joint, weight }).collect();
        mesh.skin = Some(SkinWeights::new(influences, 4, &mesh.vertices).unwrap());
        mesh.morph_targets = (0..2)
            .map(|target| {
                let delta =
                    |deltas: &[[f32; 3]; 2]| MorphDelta { position: deltas[target], ..Default::default() };
                MorphTarget::new(points.iter().map(|(.., deltas)| delta(deltas)).collect())
            })
            .collect();
        mesh
    }

    fn coordinates() -> impl Strategy<Value = [f32; 3]> {
        prop::array::uniform3(-10.0f32..10.0)
    }

    fn transform() -> impl Strategy<Value = DAffine3> {
        let column = || prop::array::uniform3(-2.0f64..2.0).prop_map(DVec3::from);
        (column(), column(), column(), prop::array::uniform3(-50.0f64..50.0))
            .prop_map(|(x, y, z, at)| DAffine3::from_cols(x, y, z, DVec3::from(at)))
    }

    proptest! {
        #[test]
        fn posed_bounds_contain_every_posed_vertex(
            points in prop::collection::vec(
                (
                    coordinates(),
                    prop::array::uniform4((0u32..3, 0.0f32..1.0)),
                    prop::array::uniform2(coordinates()),
                ),
                1..20,
            ),
            joints in prop::collection::vec(transform(), 3),
            weights in prop::collection::vec(-2.0f32..2.0, 0..3),
            is_skinned in any::<bool>(),
        ) {
            let mesh = mesh(&points);
            let joints = if is_skinned { joints } else { Vec::new() };
            let pose = MeshPose { joints: joints.into(), weights };
            let bounds = mesh.posed_bounds(&pose);
            for vertex in mesh.posed_vertices(&pose) {
                prop_assert!(bounds.contains_point(position(&vertex)), "{vertex:?} is not in {bounds:?}");
            }
        }
    }

    #[test]
    fn bounds_of_a_pose_are_those_of_what_its_joints_move() {
        let point = |x, joint| ([x, 0.0, 0.0], [(joint, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)], [[0.0; 3]; 2]);
        let mesh = mesh(&[point(1.0, 0), point(2.0, 0), point(5.0, 1)]);
        let at = |x| DAffine3::from_translation(DVec3::X * x);
        let pose = MeshPose { joints: [at(0.0), at(-10.0)].into(), weights: Vec::new() };
        let bounds = mesh.posed_bounds(&pose);
        assert!((bounds.min.x + 5.0).abs() < 1e-3 && (bounds.max.x - 2.0).abs() < 1e-3, "{bounds:?}");
    }

    #[test]
    fn normals_stay_perpendicular_to_their_surface() {
        let mut mesh = mesh(&[([0.0; 3], [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)], [[0.0; 3]; 2])]);
        let tangent = DVec3::new(1.0, 1.0, 0.0).normalize();
        mesh.vertices[0].normal = DVec3::new(1.0, -1.0, 0.0).normalize().as_vec3().to_array();
        mesh.vertices[0].tangent = tangent.as_vec3().extend(-1.0).to_array();
        for scale in [DVec3::new(3.0, 1.0, 1.0), DVec3::new(3.0, 1.0, -1.0), DVec3::new(0.0, 1.0, 1.0)] {
            let joint = DAffine3::from_scale(scale);
            let posed = mesh.posed_vertices(&MeshPose { joints: [joint].into(), weights: Vec::new() })[0];
            let expected = (scale * tangent).normalize();
            let [x, y, z, side] = posed.tangent;
            assert!(vector([x, y, z]).abs_diff_eq(expected, 1e-6) && side == -1.0);
            assert!(vector(posed.normal).dot(expected).abs() < 1e-6, "{scale}: {:?}", posed.normal);
            assert!((vector(posed.normal).length() - 1.0).abs() < 1e-6);
        }
    }
}
