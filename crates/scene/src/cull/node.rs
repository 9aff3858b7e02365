//! The nodes of a tree. Their layout follows from the number of items alone, so nodes store no links.

use std::ops::Range;

/// Number of items per leaf.
pub(crate) const LEAF_ITEMS: usize = 8;

/// A node: consecutive leaves. Its number is its index in depth-first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) number: usize,
    first_leaf: usize,
    leaves: usize,
}

impl Node {
    /// Returns the root; `None` without items.
    pub(crate) fn root(items: usize) -> Option<Self> {
        (items > 0).then(|| Self { number: 0, first_leaf: 0, leaves: items.div_ceil(LEAF_ITEMS) })
    }

    /// Returns the number of nodes in the subtree, this one included.
    pub(crate) fn count(self) -> usize {
        2 * self.leaves - 1
    }

    /// Returns the two children; `None` for a leaf.
    pub(crate) fn children(self) -> Option<[Self; 2]> {
        (self.leaves > 1).then(|| {
            let middle = self.leaves.div_ceil(2);
            let first = Self { number: self.number + 1, leaves: middle, ..self };
            let second = Self {
                number: first.number + first.count(),
                first_leaf: self.first_leaf + middle,
                leaves: self.leaves - middle,
            };
            [first, second]
        })
    }

    /// Returns the number of items if all leaves are full, as all but the last leaf of a tree are.
    pub(crate) fn capacity(self) -> usize {
        self.leaves * LEAF_ITEMS
    }

    /// Returns the slots of its items in a tree of `items` items.
    pub(crate) fn slots(self, items: usize) -> Range<usize> {
        let start = self.first_leaf * LEAF_ITEMS;
        start..items.min(start + self.capacity())
    }

    /// Returns whether the slot belongs to the node.
    pub(crate) fn contains(self, slot: usize) -> bool {
        (self.first_leaf..self.first_leaf + self.leaves).contains(&(slot / LEAF_ITEMS))
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;

    fn walk(node: Node, items: usize, depth: usize, visit: &mut impl FnMut(Node, usize)) {
        visit(node, depth);
        for child in node.children().into_iter().flatten() {
            assert!(!child.slots(items).is_empty());
            walk(child, items, depth + 1, visit);
        }
    }

    #[test]
    fn every_slot_is_in_one_leaf_and_every_node_has_its_number() {
        assert_eq!(Node::root(0), None);
        for items in (1..200).chain([1000, 4097]) {
            let root = Node::root(items).unwrap();
            let (mut numbers, mut slots) = (Vec::new(), Vec::new());
            walk(root, items, 0, &mut |node, _| {
                numbers.push(node.number);
                if node.children().is_none() {
                    slots.extend(node.slots(items));
                }
            });
            assert_eq!(numbers, (0..root.count()).collect::<Vec<_>>());
            assert_eq!(slots, (0..items).collect::<Vec<_>>());
        }
    }

    #[test]
    fn children_divide_the_slots_of_their_node() {
        walk(Node::root(1003).unwrap(), 1003, 0, &mut |node, _| {
            let own = node.slots(1003);
            assert!((0..1003).all(|slot| node.contains(slot) == own.contains(&slot)));
            if let Some([first, second]) = node.children() {
                assert_eq!((first.slots(1003).start, second.slots(1003).end), (own.start, own.end));
                assert_eq!(first.slots(1003).end, second.slots(1003).start);
                assert_eq!(first.slots(1003).len(), first.capacity());
            }
        });
    }

    #[test]
    fn a_million_items_are_no_deeper_than_their_number_needs() {
        let mut deepest = 0;
        walk(Node::root(1_000_000).unwrap(), 1_000_000, 0, &mut |_, depth| deepest = deepest.max(depth));
        assert_eq!(deepest, 17);
    }
}
