//! The lower level: a tree over the triangles of one mesh, in its own space.

use std::ops::Range;

use glam::{DVec3, Vec3};
use obvhs::aabb::Aabb;

use super::Error;
use super::gpu_structs::{RayNode, RayTriangle};
use super::keys::RayInstanceKey;
use super::pool::Pool;
use super::tree::{self, MESH_DEPTH};

/// Largest absolute coordinate of a valid corner, in the mesh and in the world, metres: products of three such numbers still fit into f32.
pub(crate) const MAX_COORDINATE_M: f32 = 1e9;

/// Largest number of triangles in a leaf.
const LEAF: usize = 8;

/// A tree that was refitted to a pose is rebuilt when it costs this many times as much as when it was built.
const DEGRADED: f64 = 1.5;

/// A mesh in the pools.
pub(crate) struct Mesh {
    /// Number of triangles that were given, valid or not.
    pub(crate) given: usize,
    /// Its nodes; empty without a valid triangle.
    pub(crate) nodes: Range<u32>,
    pub(crate) triangles: Range<u32>,
    /// The cost of the tree when it was built.
    built_cost: f64,
    /// The instances of the mesh.
    pub(crate) users: Vec<RayInstanceKey>,
}

impl Mesh {
    /// Builds the tree over the valid triangles.
    pub(crate) fn build(
        corners: &[[Vec3; 3]],
        nodes: &mut Pool<RayNode>,
        triangles: &mut Pool<RayTriangle>,
    ) -> Result<Self, Error> {
        let full = || Error::TooMany { count: corners.len() };
        let valid: Vec<_> = (0..).zip(corners).filter(|(_, corners)| is_valid(corners)).collect();
        let valid: Vec<_> = valid.iter().map(|&(index, &corners)| RayTriangle::new(corners, index)).collect();
        let mut mesh =
            Self { given: corners.len(), nodes: 0..0, triangles: 0..0, built_cost: 0.0, users: Vec::new() };
        if valid.is_empty() {
            return Ok(mesh);
        }
        let boxes: Vec<Aabb> = valid.iter().map(RayTriangle::bounds).collect();
        let mut tree = tree::build(&boxes, MESH_DEPTH, LEAF);
        let in_order: Vec<_> = tree.order.iter().map(|&index| valid[index as usize]).collect();
        mesh.built_cost = tree::cost(&tree.nodes);
        mesh.triangles = triangles.insert(&in_order).ok_or_else(full)?;
        let Some(range) = nodes.insert(&vec![RayNode::default(); tree.nodes.len()]) else {
            triangles.remove(mesh.triangles);
            return Err(full());
        };
        for node in &mut tree.nodes {
            node.first += if node.count > 0 { mesh.triangles.start } else { range.start };
        }
        nodes.write(range.start, &tree.nodes);
        mesh.nodes = range;
        Ok(mesh)
    }

    /// Refits the tree to other corners of its triangles. Returns false, and changes nothing, if other triangles than before are valid or
    /// the tree has degraded: then it has to be built again.
    pub(crate) fn refit(
        &self,
        corners: &[[Vec3; 3]],
        nodes: &mut Pool<RayNode>,
        triangles: &mut Pool<RayTriangle>,
    ) -> bool {
        let valid = corners.iter().filter(|corners| is_valid(corners)).count();
        let posed: Option<Vec<_>> = (triangles.slice(self.triangles.clone()).iter())
            .map(|old| Some(RayTriangle::new(*corners.get(old.index as usize)?, old.index)))
            .collect();
        let posed = posed.unwrap_or_default();
        let same = corners.len() == self.given && posed.len() == valid;
        if !same || !posed.iter().all(|triangle| is_valid(&triangle.corners())) {
            return false;
        }
        let mut tree = nodes.slice(self.nodes.clone()).to_vec();
        let first = self.triangles.start;
        tree::refit(&mut tree, self.nodes.start, |range| {
            let leaf = &posed[(range.start - first) as usize..(range.end - first) as usize];
            leaf.iter().fold(Aabb::empty(), |all, triangle| all.union(&triangle.bounds()))
        });
        if tree::cost(&tree) > DEGRADED * self.built_cost {
            return false;
        }
        nodes.write(self.nodes.start, &tree);
        triangles.write(self.triangles.start, &posed);
        true
    }

    /// Frees its nodes and triangles.
    pub(crate) fn free(&self, nodes: &mut Pool<RayNode>, triangles: &mut Pool<RayTriangle>) {
        nodes.remove(self.nodes.clone());
        triangles.remove(self.triangles.clone());
    }
}

/// Returns whether rays can be tested against a triangle: corners finite and within 1e9 m, area above 0.
fn is_valid(corners: &[Vec3; 3]) -> bool {
    let near = |corner: &Vec3| corner.is_finite() && corner.abs().max_element() <= MAX_COORDINATE_M;
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    corners.iter().all(near) && (b - a).cross(c - a) != DVec3::ZERO
}
