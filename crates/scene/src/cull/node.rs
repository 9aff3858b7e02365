//! The shape of a tree. It follows from the number of items alone, so nodes need not be linked.

use std::ops::Range;

#[cfg(test)]
mod tests;

/// How many items share a leaf.
pub(crate) const LEAF_ITEMS: usize = 8;

/// A node: some leaves in a row. Its number is its place in depth-first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Node {
    pub(crate) number: usize,
    first_leaf: usize,
    leaves: usize,
}

impl Node {
    /// The node above all others; `None` where there are no items.
    pub(crate) fn root(items: usize) -> Option<Self> {
        (items > 0).then(|| Self { number: 0, first_leaf: 0, leaves: items.div_ceil(LEAF_ITEMS) })
    }

    /// How many nodes there are from this one down.
    pub(crate) fn count(self) -> usize {
        2 * self.leaves - 1
    }

    /// The two nodes below; `None` for a leaf.
    pub(crate) fn halves(self) -> Option<[Self; 2]> {
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

    /// How many items there are in it if its leaves are full, as all but the last of a tree are.
    pub(crate) fn capacity(self) -> usize {
        self.leaves * LEAF_ITEMS
    }

    /// The slots of its items, of `items` in all.
    pub(crate) fn slots(self, items: usize) -> Range<usize> {
        let start = self.first_leaf * LEAF_ITEMS;
        start..items.min(start + self.capacity())
    }

    /// Tells whether the slot is one of its own.
    pub(crate) fn has(self, slot: usize) -> bool {
        (self.first_leaf..self.first_leaf + self.leaves).contains(&(slot / LEAF_ITEMS))
    }
}
