//! Building a tree: halves by number, across the longest side.

use crate::Aabb;
use glam::DVec3;

use super::CullTree;
use crate::cull::node::Node;
use crate::cull::volume::within_space;

/// Halving by number keeps the tree balanced, so its depth and the stack of its walks stay below 32 whatever the
/// boxes are.
pub(super) fn build(bounds: &[Aabb]) -> CullTree {
    let bounds: Vec<Aabb> = bounds.iter().map(within_space).collect();
    let mut items: Vec<u32> = (0u32..).zip(&bounds).map(|(item, _)| item).collect();
    let root = Node::root(items.len());
    if let Some(root) = root {
        arrange(root, &mut items, &bounds.iter().map(middle).collect::<Vec<_>>());
    }
    let mut slots = vec![0; items.len()];
    for (slot, &item) in (0u32..).zip(&items) {
        slots[item as usize] = slot;
    }
    let boxes = items.iter().map(|&item| bounds[item as usize]).collect();
    let nodes = vec![Aabb::EMPTY; root.map_or(0, Node::count)];
    let mut tree = CullTree { nodes, boxes, items, slots };
    if let Some(root) = root {
        tree.refit_below(root);
    }
    tree
}

/// Where a box is sorted in. Empty ones come last, together, so that others are found without them.
fn middle(bounds: &Aabb) -> DVec3 {
    if bounds.is_empty() { DVec3::INFINITY } else { bounds.center() }
}

/// Orders the items of a node: those of its first half, then those of its second, and so on down to the leaves.
fn arrange(node: Node, items: &mut [u32], middles: &[DVec3]) {
    let Some([first, second]) = node.halves() else {
        return items.sort_unstable();
    };
    let axis = longest_side(items, middles);
    let place = |item: u32| middles[item as usize][axis];
    let end_of_first = first.capacity();
    items.select_nth_unstable_by(end_of_first, |&a, &b| place(a).total_cmp(&place(b)).then(a.cmp(&b)));
    let (items_of_first, items_of_second) = items.split_at_mut(end_of_first);
    arrange(first, items_of_first, middles);
    arrange(second, items_of_second, middles);
}

/// The axis along which the middles lie furthest apart.
fn longest_side(items: &[u32], middles: &[DVec3]) -> usize {
    let middles = items.iter().map(|&item| middles[item as usize]).filter(|middle| middle.is_finite());
    Aabb::from_points(middles).half_extent().max_position()
}
