//! The joints that move the vertices of a mesh.

use bytemuck::{Pod, Zeroable};

use super::{Vertex, position};
use crate::bounds::Aabb;

/// The share that a joint has in the movement of a vertex, 8 bytes, as the GPU reads it.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Influence {
    /// Index into the joints of the skin.
    pub joint: u32,
    /// The share, 0 to 1.
    pub weight: f32,
}

/// The influences of each vertex of a mesh; the weights of a vertex add up to 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SkinWeights {
    influences: Vec<Influence>,
    per_vertex: usize,
    joint_bounds: Vec<Aabb>,
}

impl SkinWeights {
    /// Creates the weights of a mesh with these vertices from `per_vertex` influences of each. Weights are scaled so that they add up
    /// to 1; a vertex without weights follows its first joint.
    ///
    /// # Errors
    /// One line, for a weight below 0 or not finite, and another number of influences.
    pub fn new(
        mut influences: Vec<Influence>,
        per_vertex: usize,
        vertices: &[Vertex],
    ) -> Result<Self, String> {
        if per_vertex == 0 || Some(influences.len()) != per_vertex.checked_mul(vertices.len()) {
            let (given, count) = (influences.len(), vertices.len());
            return Err(format!("{given} influences of {count} vertices (allowed: {per_vertex} for each)"));
        }
        for (vertex, influences) in influences.chunks_exact_mut(per_vertex).enumerate() {
            let invalid = |influence: &&Influence| !(influence.weight >= 0.0 && influence.weight.is_finite());
            if let Some(Influence { weight, .. }) = influences.iter().find(invalid) {
                return Err(format!("the weight of vertex {vertex} is {weight} (allowed: 0 or more)"));
            }
            normalize(influences);
        }
        let joint_bounds = joint_bounds(&influences, per_vertex, vertices);
        Ok(Self { influences, per_vertex, joint_bounds })
    }

    /// Returns the influences of all vertices, those of the first vertex first.
    #[must_use]
    pub fn influences(&self) -> &[Influence] {
        &self.influences
    }

    /// Returns the number of influences of a vertex.
    #[must_use]
    pub fn per_vertex(&self) -> usize {
        self.per_vertex
    }

    /// Returns the influences of a vertex; none if it does not exist.
    #[must_use]
    pub fn vertex(&self, vertex: usize) -> &[Influence] {
        self.influences
            .get(vertex * self.per_vertex..)
            .map_or(&[], |rest| &rest[..self.per_vertex.min(rest.len())])
    }

    /// Returns the bounds of the vertices that each joint moves, in the mesh's own space; empty for those that move none. A skin needs
    /// as many joints.
    #[must_use]
    pub fn joint_bounds(&self) -> &[Aabb] {
        &self.joint_bounds
    }

    /// Returns the influences of these vertices.
    pub(super) fn select(&self, vertices: &[u32]) -> Self {
        let influences = vertices.iter().flat_map(|vertex| self.vertex(*vertex as usize)).copied().collect();
        Self { influences, ..self.clone() }
    }
}

/// Returns the bounds of the vertices that each joint moves.
fn joint_bounds(influences: &[Influence], per_vertex: usize, vertices: &[Vertex]) -> Vec<Aabb> {
    let count = influences.iter().map(|influence| influence.joint as usize + 1).max().unwrap_or(0);
    let mut bounds = vec![Aabb::EMPTY; count];
    for (vertex, influences) in vertices.iter().zip(influences.chunks_exact(per_vertex)) {
        let point = Aabb::from_points([position(vertex)]);
        for influence in influences.iter().filter(|influence| influence.weight > 0.0) {
            if let Some(bounds) = bounds.get_mut(influence.joint as usize) {
                *bounds = bounds.union(&point);
            }
        }
    }
    bounds
}

/// Scales weights to a sum of 1. Joints without weight become joint 0, which every skin has.
fn normalize(influences: &mut [Influence]) {
    let sum: f64 = influences.iter().map(|influence| f64::from(influence.weight)).sum();
    if sum == 0.0 {
        influences.iter_mut().take(1).for_each(|influence| influence.weight = 1.0);
    } else {
        for influence in influences.iter_mut() {
            influence.weight = (f64::from(influence.weight) / sum) as f32;
        }
    }
    influences
        .iter_mut()
        .filter(|influence| influence.weight == 0.0)
        .for_each(|influence| influence.joint = 0);
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    fn influences(weights: &[(u32, f32)]) -> Vec<Influence> {
        weights.iter().map(|&(joint, weight)| Influence { joint, weight }).collect()
    }

    #[test]
    fn weights_add_up_to_1_and_joints_without_weight_are_not_needed() {
        let weights = influences(&[(2, 1.0), (3, 3.0), (9, 0.0), (0, 0.0)]);
        let skin = SkinWeights::new(weights, 4, &[Vertex::default()]).unwrap();
        assert_eq!(skin.influences(), influences(&[(2, 0.25), (3, 0.75), (0, 0.0), (0, 0.0)]));
        assert_eq!(skin.joint_bounds().len(), 4);
        assert!(skin.joint_bounds()[..2].iter().all(Aabb::is_empty) && !skin.joint_bounds()[2].is_empty());
    }

    #[test]
    fn a_vertex_without_weights_follows_its_first_joint() {
        let skin = SkinWeights::new(influences(&[(5, 0.0), (3, 0.0)]), 2, &[Vertex::default()]).unwrap();
        assert_eq!(skin.influences(), influences(&[(5, 1.0), (0, 0.0)]));
    }

    #[test]
    fn invalid_weights_are_rejected_in_one_line() {
        for (weight, text) in [(-0.5, "-0.5"), (f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
            let weights = influences(&[(0, 1.0), (0, 0.0), (0, 0.5), (0, weight)]);
            let error = SkinWeights::new(weights, 2, &[Vertex::default(); 2]).unwrap_err();
            assert_eq!(error, format!("the weight of vertex 1 is {text} (allowed: 0 or more)"));
        }
        let error = SkinWeights::new(influences(&[(0, 1.0)]), 2, &[Vertex::default()]).unwrap_err();
        assert_eq!(error, "1 influences of 1 vertices (allowed: 2 for each)");
    }
}
