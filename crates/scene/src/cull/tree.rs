//! A tree of boxes.

use crate::Aabb;

use crate::cull::node::Node;
use crate::cull::parts::{Parts, Place, Settled};
use crate::cull::volume::within_space;
use crate::cull::{CullVolume, ascending};

mod build;
#[cfg(test)]
mod tests;

/// Many boxes, one per item, arranged so that those that touch a volume are found without testing all.
///
/// It is a binary tree of boxes around boxes. Items are numbered as in the list it was made from.
#[derive(Clone, Debug)]
pub struct CullTree {
    /// The bounds of all below, by the node's number.
    nodes: Vec<Aabb>,
    /// The bounds of an item, by slot. Items of a node are in slots in a row.
    boxes: Vec<Aabb>,
    /// The item in each slot.
    items: Vec<u32>,
    /// The slot of each item.
    slots: Vec<u32>,
}

impl CullTree {
    /// Arranges the boxes, item `i` being `bounds[i]`. Empty boxes are items too, but in no volume until
    /// [`refit`](Self::refit) gives them another box.
    ///
    /// ```
    /// use shadowgraph_scene::{CullTree, CullVolume};
    /// use glam::DVec3;
    /// use shadowgraph_scene::{Aabb, ConvexVolume, Plane};
    /// let boxes = [0.0, 5.0, 9.0].map(|x| Aabb { min: DVec3::X * x, max: DVec3::X * x + DVec3::ONE });
    /// let tree = CullTree::new(&boxes);
    /// let planes = vec![Plane::through(DVec3::X * 4.0, DVec3::X)];
    /// let mut found = Vec::new();
    /// tree.query(&CullVolume::from(ConvexVolume { planes }), &mut found);
    /// assert_eq!(found, [1, 2]);
    /// ```
    #[must_use]
    pub fn new(bounds: &[Aabb]) -> Self {
        build::build(bounds)
    }

    /// Appends the items whose boxes touch the volume, ascending: exactly those for which
    /// [`CullVolume::intersects`] is true.
    pub fn query(&self, volume: &CullVolume, found: &mut Vec<u32>) {
        let start = found.len();
        if let Some(root) = self.root() {
            self.find(root, &Parts::new(volume), Settled::default(), found);
        }
        ascending::sort(found, start, self.items.len());
    }

    /// Gives items other boxes, empty ones too. Items that there are not are passed over.
    ///
    /// This takes a walk down the tree per item. Where they lie in the tree stays as it is, so queries become slower
    /// when items move far, never wrong; a new tree is then better.
    pub fn refit(&mut self, changed: impl IntoIterator<Item = (u32, Aabb)>) {
        let Some(root) = self.root() else { return };
        for (item, bounds) in changed {
            if let Some(&slot) = self.slots.get(item as usize) {
                self.boxes[slot as usize] = within_space(&bounds);
                self.refit_around(root, slot as usize);
            }
        }
    }

    /// Returns the smallest box around all boxes; [`Aabb::EMPTY`] if all are empty.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().copied().unwrap_or(Aabb::EMPTY)
    }

    /// Returns the box of an item, cut off 10^100 m from the origin; [`Aabb::EMPTY`] for an empty one and for an
    /// item that there is not.
    #[must_use]
    pub fn item_bounds(&self, item: u32) -> Aabb {
        self.slots.get(item as usize).map_or(Aabb::EMPTY, |&slot| self.boxes[slot as usize])
    }

    fn root(&self) -> Option<Node> {
        Node::root(self.items.len())
    }

    /// Appends what touches below a node, in the order of slots.
    fn find(&self, node: Node, volume: &Parts<'_>, settled: Settled, found: &mut Vec<u32>) {
        match volume.place(&self.nodes[node.number], settled) {
            Place::Outside => {}
            Place::Inside => self.append(node, |bounds| !bounds.is_empty(), found),
            Place::Across(settled) => match node.halves() {
                Some(halves) => halves.into_iter().for_each(|half| self.find(half, volume, settled, found)),
                None => self.append(node, |bounds| volume.touch(bounds, settled), found),
            },
        }
    }

    fn append(&self, node: Node, keep: impl Fn(&Aabb) -> bool, found: &mut Vec<u32>) {
        let slots = node.slots(self.items.len());
        let items = self.items[slots.clone()].iter().zip(&self.boxes[slots]);
        found.extend(items.filter(|(_, bounds)| keep(bounds)).map(|(&item, _)| item));
    }

    /// Computes the bounds anew of the nodes around a slot, from its leaf up to where nothing changes. Tells whether
    /// this node's changed.
    fn refit_around(&mut self, node: Node, slot: usize) -> bool {
        let below = node.halves().and_then(|halves| halves.into_iter().find(|half| half.has(slot)));
        if below.is_some_and(|half| !self.refit_around(half, slot)) {
            return false;
        }
        let before = self.nodes[node.number];
        self.nodes[node.number] = self.around(node);
        self.nodes[node.number] != before
    }

    /// Computes the bounds anew of this node and all below it.
    fn refit_below(&mut self, node: Node) {
        for half in node.halves().into_iter().flatten() {
            self.refit_below(half);
        }
        self.nodes[node.number] = self.around(node);
    }

    /// The bounds of a node whose halves have theirs.
    fn around(&self, node: Node) -> Aabb {
        match node.halves() {
            Some([first, second]) => self.nodes[first.number].union(&self.nodes[second.number]),
            None => self.boxes[node.slots(self.items.len())]
                .iter()
                .fold(Aabb::EMPTY, |all, bounds| all.union(bounds)),
        }
    }
}
