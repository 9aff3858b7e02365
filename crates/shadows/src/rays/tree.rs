//! Bounding volume hierarchies over boxes.

use std::ops::Range;

use obvhs::{
    BvhBuildParams,
    aabb::Aabb,
    bvh2::{Bvh2, leaf_collapser::collapse, node::Bvh2Node, reinsertion::ReinsertionOptimizer},
    ploc::PlocBuilder,
};

use super::gpu_structs::RayNode;

/// Largest depth of the tree of a mesh.
pub const MESH_DEPTH: usize = 64;

/// Largest depth of the tree over the instances.
pub const TOP_DEPTH: usize = 32;

/// A tree: the root first, the children of a node next to each other and after it. Indices count from its first node.
pub(crate) struct Tree {
    pub(crate) nodes: Vec<RayNode>,
    /// The indices of the boxes in the order of the leaves.
    pub(crate) order: Vec<u32>,
}

/// Builds a tree over at least one box, of at most `depth` levels (32 or more) and `leaf` boxes in a leaf.
pub(crate) fn build(boxes: &[Aabb], depth: usize, leaf: usize) -> Tree {
    let tree = clustered(boxes, leaf);
    let tree = if levels(&tree) > depth { balanced(boxes, leaf) } else { tree };
    in_order(&tree, boxes)
}

/// Returns the tree with children after their parents, and with the exact boxes.
fn in_order(tree: &Bvh2, boxes: &[Aabb]) -> Tree {
    let mut nodes = vec![RayNode::default()];
    let mut open = vec![(0, 0)];
    while let Some((from, to)) = open.pop() {
        let node: &Bvh2Node = &tree.nodes[from];
        let mut first = node.first_index;
        if !node.is_leaf() {
            let pair = nodes.len();
            nodes.extend([RayNode::default(); 2]);
            open.extend([(first as usize + 1, pair + 1), (first as usize, pair)]);
            first = pair as u32;
        }
        nodes[to] = RayNode::new(node.aabb(), first, node.prim_count);
    }
    let mut tree = Tree { nodes, order: tree.primitive_indices.clone() };
    let order = &tree.order;
    refit(&mut tree.nodes, 0, |range| around(boxes, &order[range.start as usize..range.end as usize]));
    tree
}

/// Recomputes the boxes of a tree from those of its leaves. `base` is the index of its root in the indices of its nodes.
pub(crate) fn refit(nodes: &mut [RayNode], base: u32, leaf: impl Fn(Range<u32>) -> Aabb) {
    for index in (0..nodes.len()).rev() {
        let RayNode { first, count, .. } = nodes[index];
        let bounds = if count > 0 {
            leaf(first..first + count)
        } else {
            let pair = (first - base) as usize;
            nodes[pair].bounds().union(&nodes[pair + 1].bounds())
        };
        nodes[index] = RayNode::new(&bounds, first, count);
    }
}

/// Returns the expected number of boxes that a ray through the root's box is tested against: the sum of the areas of the inner nodes over
/// that of the root (MacDonald and Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990).
pub(crate) fn cost(nodes: &[RayNode]) -> f64 {
    let inner = nodes.iter().filter(|node| node.count == 0);
    let sum: f64 = inner.map(area).sum();
    sum / nodes.first().map_or(1.0, area).max(f64::MIN_POSITIVE)
}

/// Returns half of the area of a node's box.
pub(crate) fn area(node: &RayNode) -> f64 {
    f64::from(node.bounds().half_area())
}

/// Widens boxes by different amounts: among equal boxes, clustering would find only one pair at a time.
fn distinct(boxes: &[Aabb]) -> Vec<Aabb> {
    let largest = boxes.iter().map(|one| one.min.abs().max(one.max.abs()).max_element()).fold(0.0, f32::max);
    let margin = largest / (1 << 18) as f32;
    let widened = |(index, one): (u32, &Aabb)| {
        let fraction = (index.wrapping_mul(0x9e37_79b9) >> 8) as f32 / (1 << 24) as f32;
        Aabb { min: one.min - margin * (1.0 + fraction), max: one.max + margin * (1.0 + fraction) }
    };
    (0..).zip(boxes).map(widened).collect()
}

/// Builds a tree as `obvhs::bvh2::builder::build_bvh2` does, without its validation, which can panic.
fn clustered(boxes: &[Aabb], leaf: usize) -> Bvh2 {
    let boxes = distinct(boxes);
    let indices = (0..boxes.len() as u32).collect();
    let params = BvhBuildParams::medium_build();
    let mut builder = PlocBuilder::with_capacity(boxes.len());
    let (distance, precision) = (params.ploc_search_distance, params.sort_precision);
    let mut tree = builder.build(distance, &boxes, indices, precision, params.search_depth_threshold);
    let mut reinsertion = ReinsertionOptimizer::default();
    reinsertion.run(&mut tree, params.reinsertion_batch_ratio, None);
    if leaf > 1 {
        collapse(&mut tree, leaf as u32, params.collapse_traversal_cost);
        let again = params.reinsertion_batch_ratio * params.post_collapse_reinsertion_batch_ratio_multiplier;
        reinsertion.run(&mut tree, again, None);
    }
    tree
}

/// Builds a tree that halves the boxes at each level: slower to traverse, but at most 32 levels deep for any
/// boxes (clustering builds a chain of nested boxes for some).
fn balanced(boxes: &[Aabb], leaf: usize) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..boxes.len())];
    while let Some((node, range)) = open.pop() {
        let around = around(boxes, &order[range.clone()]);
        nodes[node] = if range.len() <= leaf {
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
fn levels(tree: &Bvh2) -> usize {
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
