//! The bounding volume hierarchy over the triangles.

use std::ops::Range;

use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, leaf_collapser::collapse, node::Bvh2Node, reinsertion::ReinsertionOptimizer},
    ploc::PlocBuilder,
};

use super::Occluder;

/// Largest depth of the tree: the shader's stack has an entry for each level.
pub const MAX_DEPTH: usize = 64;

/// Smallest margin around the tree's boxes, relative to the scene's largest coordinate: 64 times the rounding error of
/// f32, more than the error of the test of a ray and a box (16 times, with WGSL's division).
const BOX_MARGIN: f32 = 1.0 / (1 << 18) as f32;

/// Largest number of triangles in a leaf of a balanced tree.
const BALANCED_LEAF: usize = 4;

/// Builds a tree of at most [`MAX_DEPTH`] levels.
pub(crate) fn build(occluders: &[&Occluder], max_coordinate_m: f32) -> Bvh2 {
    if occluders.is_empty() {
        return Bvh2::default();
    }
    let margin_m = max_coordinate_m * BOX_MARGIN;
    let boxes: Vec<Aabb> =
        (0u32..).zip(occluders).map(|(i, occluder)| bounds(i, occluder, margin_m)).collect();
    let tree = clustered(&boxes);
    if depth(&tree) > MAX_DEPTH { balanced(&boxes) } else { tree }
}

/// Returns the box of a triangle, widened by one to two margins. The margins of boxes differ: among equal boxes,
/// clustering would find only one pair at a time.
fn bounds(index: u32, occluder: &Occluder, margin_m: f32) -> Aabb {
    let [a, b, c] = occluder.corners;
    let fraction = (index.wrapping_mul(0x9e37_79b9) >> 8) as f32 / (1 << 24) as f32;
    let margin_m = margin_m * (1.0 + fraction);
    Aabb::new((a.min(b).min(c) - margin_m).into(), (a.max(b).max(c) + margin_m).into())
}

/// Builds a tree as `obvhs::bvh2::builder::build_bvh2` does, without its validation, which can panic.
fn clustered(boxes: &[Aabb]) -> Bvh2 {
    let indices = (0..boxes.len() as u32).collect();
    let params = BvhBuildParams::medium_build();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let (distance, precision) = (params.ploc_search_distance, params.sort_precision);
    let mut tree = builder.build(distance, boxes, indices, precision, params.search_depth_threshold);
    let mut reinsertion = ReinsertionOptimizer::default();
    reinsertion.run(&mut tree, params.reinsertion_batch_ratio, None);
    collapse(&mut tree, params.max_prims_per_leaf, params.collapse_traversal_cost);
    let again = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
    reinsertion.run(&mut tree, again, None);
    tree
}

/// Builds a tree that halves the triangles at each level: slower to traverse, but at most 30 levels deep for any
/// triangles (clustering builds a chain of nested boxes for some).
fn balanced(boxes: &[Aabb]) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..boxes.len())];
    while let Some((node, range)) = open.pop() {
        let around = around(boxes, &order[range.clone()]);
        nodes[node] = if range.len() <= BALANCED_LEAF {
            Bvh2Node::new(around, range.len() as u32, range.start as u32)
        } else {
            let first = nodes.len();
            let halves = halves(boxes, &mut order, &range, around.largest_axis());
            nodes.extend([Bvh2Node::default(); 2]);
            open.extend((first..).zip(halves));
            Bvh2Node::new(around, 0, first as u32)
        };
    }
    Bvh2 { nodes, primitive_indices: order, ..Bvh2::default() }
}

fn around(boxes: &[Aabb], indices: &[u32]) -> Aabb {
    let boxes = indices.iter().filter_map(|&index| boxes.get(index as usize));
    boxes.fold(Aabb::empty(), |all, one| all.union(one))
}

/// Moves the boxes that are lower along the axis into the first half of the range, and returns the halves.
fn halves(boxes: &[Aabb], order: &mut [u32], range: &Range<usize>, axis: usize) -> [Range<usize>; 2] {
    let middle = range.start + range.len() / 2;
    let center = |index: &u32| boxes[*index as usize].center_axis(axis);
    order[range.clone()]
        .select_nth_unstable_by(range.len() / 2, |a, b| center(a).total_cmp(&center(b)).then(a.cmp(b)));
    [range.start..middle, middle..range.end]
}

/// Returns the number of levels of the tree.
fn depth(tree: &Bvh2) -> usize {
    let mut deepest = 0;
    let mut open = vec![(0, 1)];
    while let Some((index, depth)) = open.pop() {
        let Some(node) = tree.nodes.get(index) else { continue };
        deepest = deepest.max(depth);
        if !node.is_leaf() {
            let first = node.first_index as usize;
            open.extend([(first, depth + 1), (first + 1, depth + 1)]);
        }
    }
    deepest
}
