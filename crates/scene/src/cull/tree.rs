//! A bounding volume hierarchy of boxes.

use glam::DVec3;

use crate::bounds::Aabb;
use crate::cull::node::Node;
use crate::cull::sort::sort_distinct;
use crate::cull::volume::{Containment, CullVolume, PreparedVolume, ShapeMask, clip_to_space};

#[cfg(test)]
mod tests;

/// Above the number of items divided by this, a refit of all nodes is faster than one descent per changed item.
const MANY: usize = 8;

/// Many boxes, one per item, arranged so that those that intersect a volume are found without testing all.
///
/// It is a binary bounding volume hierarchy. Items are numbered as in the list that the tree was built from.
#[derive(Clone, Debug)]
pub struct CullTree {
    /// The bounds of each node, by the node's number.
    nodes: Vec<Aabb>,
    /// The bounds of each item, by slot. Items of a node have consecutive slots.
    boxes: Vec<Aabb>,
    /// The item in each slot.
    items: Vec<u32>,
    /// The slot of each item.
    slots: Vec<u32>,
    /// The half area of each node when the tree was built.
    built_areas: Vec<f64>,
    /// The number of nodes that have more than twice that area.
    grown: usize,
}

impl CullTree {
    /// Builds the tree; item `i` has the box `bounds[i]`. Empty boxes are items too, but intersect no volume until
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
        build(bounds)
    }

    /// Appends the items whose boxes intersect the volume, ascending: exactly those for which
    /// [`CullVolume::intersects`] is true.
    pub fn query(&self, volume: &CullVolume, found: &mut Vec<u32>) {
        let start = found.len();
        if let Some(root) = self.root() {
            self.find(root, &PreparedVolume::new(volume), ShapeMask::default(), found);
        }
        sort_distinct(found, start, self.items.len());
    }

    /// Returns whether any item's box intersects the volume.
    #[must_use]
    pub fn any(&self, volume: &CullVolume) -> bool {
        self.root().is_some_and(|root| self.finds(root, &PreparedVolume::new(volume), ShapeMask::default()))
    }

    /// Returns the number of items.
    #[must_use]
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Returns whether there are no items.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Gives items new boxes, which may be empty. Items that do not exist are ignored.
    ///
    /// This costs one descent of the tree per item, and for many items one pass over all nodes. Items keep their slots, so queries get slower when items move far, but
    /// never wrong: [`rebuild`](Self::rebuild) a tree that [is degraded](Self::is_degraded).
    pub fn refit(&mut self, changed: impl IntoIterator<Item = (u32, Aabb)>) {
        let Some(root) = self.root() else { return };
        let mut count = 0;
        for (item, bounds) in changed {
            let Some(&slot) = self.slots.get(item as usize) else { continue };
            self.boxes[slot as usize] = clip_to_space(&bounds);
            count += 1;
            if count <= self.items.len() / MANY {
                self.refit_path(root, slot as usize);
            }
        }
        if count > self.items.len() / MANY {
            self.refit_subtree(root);
            self.grown = (0..self.nodes.len()).filter(|&node| self.has_grown(node)).count();
        }
    }

    /// Returns whether refits have made queries slow: a quarter of the nodes have more than
    /// twice the area that they had when the tree was built.
    #[must_use]
    pub fn is_degraded(&self) -> bool {
        self.grown > self.nodes.len() / 4
    }

    /// Builds the tree again from the present boxes.
    pub fn rebuild(&mut self) {
        let boxes: Vec<_> = (0..self.items.len() as u32).map(|item| self.item_bounds(item)).collect();
        *self = build(&boxes);
    }

    /// Returns the smallest box around all boxes; [`Aabb::EMPTY`] if all are empty.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.nodes.first().copied().unwrap_or(Aabb::EMPTY)
    }

    /// Returns the box of an item, clipped at 10^100 m from the origin; [`Aabb::EMPTY`] for an empty one and for an
    /// item that does not exist.
    #[must_use]
    pub fn item_bounds(&self, item: u32) -> Aabb {
        self.slots.get(item as usize).map_or(Aabb::EMPTY, |&slot| self.boxes[slot as usize])
    }

    fn root(&self) -> Option<Node> {
        Node::root(self.items.len())
    }

    /// Returns whether an item of a node intersects the volume.
    fn finds(&self, node: Node, volume: &PreparedVolume<'_>, inside: ShapeMask) -> bool {
        match volume.classify(&self.nodes[node.number], inside) {
            Containment::Outside => false,
            Containment::Inside => true,
            Containment::Partial(inside) => match node.children() {
                Some(children) => children.into_iter().any(|child| self.finds(child, volume, inside)),
                None => self.boxes[node.slots(self.items.len())]
                    .iter()
                    .any(|bounds| volume.intersects(bounds, inside)),
            },
        }
    }

    /// Appends the items of a node that intersect the volume, in the order of slots.
    fn find(&self, node: Node, volume: &PreparedVolume<'_>, inside: ShapeMask, found: &mut Vec<u32>) {
        match volume.classify(&self.nodes[node.number], inside) {
            Containment::Outside => {}
            Containment::Inside => self.append(node, |bounds| !bounds.is_empty(), found),
            Containment::Partial(inside) => match node.children() {
                Some(children) => {
                    children.into_iter().for_each(|child| self.find(child, volume, inside, found))
                }
                None => self.append(node, |bounds| volume.intersects(bounds, inside), found),
            },
        }
    }

    fn append(&self, node: Node, keep: impl Fn(&Aabb) -> bool, found: &mut Vec<u32>) {
        let slots = node.slots(self.items.len());
        let items = self.items[slots.clone()].iter().zip(&self.boxes[slots]);
        found.extend(items.filter(|(_, bounds)| keep(bounds)).map(|(&item, _)| item));
    }

    /// Recomputes the bounds of the nodes around a slot, from its leaf up to where nothing changes. Returns whether this
    /// node's bounds changed.
    fn refit_path(&mut self, node: Node, slot: usize) -> bool {
        let child =
            node.children().and_then(|children| children.into_iter().find(|child| child.contains(slot)));
        if child.is_some_and(|child| !self.refit_path(child, slot)) {
            return false;
        }
        let (before, had_grown) = (self.nodes[node.number], self.has_grown(node.number));
        self.nodes[node.number] = self.compute_bounds(node);
        self.grown += usize::from(self.has_grown(node.number));
        self.grown -= usize::from(had_grown);
        self.nodes[node.number] != before
    }

    /// Returns whether a node has more than twice the area that it had when the tree was built.
    fn has_grown(&self, number: usize) -> bool {
        half_area(&self.nodes[number]) > 2.0 * self.built_areas[number]
    }

    /// Recomputes the bounds of this node and all nodes below it.
    fn refit_subtree(&mut self, node: Node) {
        for child in node.children().into_iter().flatten() {
            self.refit_subtree(child);
        }
        self.nodes[node.number] = self.compute_bounds(node);
    }

    /// Returns the bounds of a node from those of its children or items.
    fn compute_bounds(&self, node: Node) -> Aabb {
        match node.children() {
            Some([first, second]) => self.nodes[first.number].union(&self.nodes[second.number]),
            None => self.boxes[node.slots(self.items.len())]
                .iter()
                .fold(Aabb::EMPTY, |all, bounds| all.union(bounds)),
        }
    }
}

/// Builds a tree by halving the items by number across their longest axis. That keeps it balanced, so its depth and the
/// recursion of its traversals stay below 32 for any boxes.
fn build(bounds: &[Aabb]) -> CullTree {
    let bounds: Vec<Aabb> = bounds.iter().map(clip_to_space).collect();
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
    let mut tree = CullTree { nodes, boxes, items, slots, built_areas: Vec::new(), grown: 0 };
    if let Some(root) = root {
        tree.refit_subtree(root);
    }
    tree.built_areas = tree.nodes.iter().map(half_area).collect();
    tree
}

/// Returns half the area of a box's surface; 0 for an empty box.
fn half_area(bounds: &Aabb) -> f64 {
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max - bounds.min;
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Returns the point that a box is sorted by. Empty boxes sort last, together, so that queries for others skip them.
fn middle(bounds: &Aabb) -> DVec3 {
    if bounds.is_empty() { DVec3::INFINITY } else { bounds.center() }
}

/// Orders the items of a node: those of its first child, then those of its second, and so on down to the leaves.
fn arrange(node: Node, items: &mut [u32], middles: &[DVec3]) {
    let Some([first, second]) = node.children() else {
        return items.sort_unstable();
    };
    let axis = longest_axis(items, middles);
    let coordinate = |item: u32| middles[item as usize][axis];
    let end_of_first = first.capacity();
    items.select_nth_unstable_by(end_of_first, |&a, &b| {
        coordinate(a).total_cmp(&coordinate(b)).then(a.cmp(&b))
    });
    let (items_of_first, items_of_second) = items.split_at_mut(end_of_first);
    arrange(first, items_of_first, middles);
    arrange(second, items_of_second, middles);
}

/// Returns the axis along which the middles are spread farthest.
fn longest_axis(items: &[u32], middles: &[DVec3]) -> usize {
    let middles = items.iter().map(|&item| middles[item as usize]).filter(|middle| middle.is_finite());
    Aabb::from_points(middles).half_extent().max_position()
}
