//! The upper level: a tree over the instances, in the world.

use obvhs::aabb::Aabb;

use super::Error;
use super::gpu_structs::{RAY_INSTANCE, RayNode};
use super::pool::Pool;
use super::tree::{self, TOP_DEPTH, area};

/// The root of the tree: it has two nodes, so that 0 is no pair of children.
const ROOT: u32 = 0;

/// The tree is rebuilt when it costs this many times as much as when it was built.
const DEGRADED: f64 = 1.5;

/// A tree whose leaves are instances, one each.
///
/// A moved leaf changes the boxes above it ([`set`](Self::set)); the structure stays until the tree is [rebuilt](Self::rebuild). Wald,
/// Boulos and Shirley, "Ray Tracing Deformable Scenes Using Dynamic Bounding Volume Hierarchies" (2007), refit so; Lauterbach et al.,
/// "RT-DEFORM" (2006), rebuild by a measure of quality.
#[derive(Default)]
pub(crate) struct InstanceTree {
    /// The parent of each of its nodes, by the node's index.
    parents: Vec<u32>,
    /// The leaf of each instance that is in the tree, by the instance's index.
    leaves: Vec<Option<u32>>,
    /// Sum of the areas of the inner nodes.
    inner_area: f64,
    /// The cost when it was built.
    built_cost: f64,
}

impl InstanceTree {
    /// Creates an empty tree in empty pools.
    pub(crate) fn new(nodes: &mut Pool<RayNode>) -> Self {
        nodes.insert(&[RayNode::default(); 2]);
        Self::default()
    }

    /// Inserts an instance, changes its box, or removes it without one.
    pub(crate) fn set(
        &mut self,
        nodes: &mut Pool<RayNode>,
        instance: u32,
        bounds: Option<Aabb>,
    ) -> Result<(), Error> {
        match (self.leaf(instance), bounds) {
            (None, None) => {}
            (Some(leaf), None) => self.remove(nodes, leaf),
            (None, Some(bounds)) => self.insert(nodes, &RayNode::new(&bounds, instance | RAY_INSTANCE, 0))?,
            (Some(leaf), Some(bounds)) => {
                nodes.set(leaf, RayNode::new(&bounds, instance | RAY_INSTANCE, 0));
                self.refit_above(nodes, leaf);
            }
        }
        Ok(())
    }

    /// Rebuilds the tree if it has degraded, and returns whether it did.
    pub(crate) fn rebuild_if_degraded(&mut self, nodes: &mut Pool<RayNode>) -> Result<bool, Error> {
        let root = area(&nodes.get(ROOT)).max(f64::MIN_POSITIVE);
        let degraded = self.inner_area / root > DEGRADED * self.built_cost.max(1.0);
        if degraded {
            self.rebuild(nodes)?;
        }
        Ok(degraded)
    }

    /// Builds the tree again.
    pub(crate) fn rebuild(&mut self, nodes: &mut Pool<RayNode>) -> Result<(), Error> {
        let leaves: Vec<RayNode> = self.leaves.iter().flatten().map(|&leaf| nodes.get(leaf)).collect();
        self.free(nodes);
        (self.inner_area, self.built_cost) = (0.0, 0.0);
        if leaves.is_empty() {
            nodes.set(ROOT, RayNode::default());
            return Ok(());
        }
        let boxes: Vec<Aabb> = leaves.iter().map(RayNode::bounds).collect();
        let mut tree = tree::build(&boxes, TOP_DEPTH, 1);
        self.built_cost = tree::cost(&tree.nodes);
        let below = vec![RayNode::default(); tree.nodes.len() - 1];
        let range = nodes.insert(&below).ok_or(Error::TooMany { count: leaves.len() })?;
        for node in &mut tree.nodes {
            node.first = if node.count > 0 {
                leaves[tree.order[node.first as usize] as usize].first
            } else {
                self.inner_area += area(node);
                node.first - 1 + range.start
            };
            node.count = 0;
        }
        nodes.set(ROOT, tree.nodes[0]);
        nodes.write(range.start, &tree.nodes[1..]);
        self.relink(ROOT, &tree.nodes[0]);
        (range.start..).zip(&tree.nodes[1..]).for_each(|(index, node)| self.relink(index, node));
        Ok(())
    }

    fn leaf(&self, instance: u32) -> Option<u32> {
        self.leaves.get(instance as usize).copied().flatten()
    }

    /// Notes that the contents of a node are at `index`.
    fn relink(&mut self, index: u32, node: &RayNode) {
        if node.is_instance() {
            *slot(&mut self.leaves, node.first & !RAY_INSTANCE) = Some(index);
        } else {
            *slot(&mut self.parents, node.first) = index;
            *slot(&mut self.parents, node.first + 1) = index;
        }
    }

    /// Makes a pair of a leaf that is already there and a new one.
    fn insert(&mut self, nodes: &mut Pool<RayNode>, leaf: &RayNode) -> Result<(), Error> {
        let root = nodes.get(ROOT);
        if root.first == 0 {
            nodes.set(ROOT, *leaf);
            self.relink(ROOT, leaf);
            return Ok(());
        }
        let (sibling, depth) = sibling(nodes, &leaf.bounds());
        let node = nodes.get(sibling);
        let pair = nodes.insert(&[node, *leaf]).ok_or(Error::TooMany { count: self.leaves.len() })?.start;
        self.relink(pair, &node);
        self.relink(pair + 1, leaf);
        let parent = RayNode::new(&node.bounds().union(&leaf.bounds()), pair, 0);
        nodes.set(sibling, parent);
        self.relink(sibling, &parent);
        self.inner_area += area(&parent);
        self.refit_above(nodes, sibling);
        if depth + 1 > TOP_DEPTH { self.rebuild(nodes) } else { Ok(()) }
    }

    /// Removes a leaf: its sibling takes the place of their parent.
    fn remove(&mut self, nodes: &mut Pool<RayNode>, leaf: u32) {
        *slot(&mut self.leaves, nodes.get(leaf).first & !RAY_INSTANCE) = None;
        if leaf == ROOT {
            nodes.set(ROOT, RayNode::default());
            return;
        }
        let parent = *slot(&mut self.parents, leaf);
        let inner = nodes.get(parent);
        let sibling = nodes.get(inner.first + u32::from(leaf == inner.first));
        self.inner_area -= area(&inner);
        nodes.set(parent, sibling);
        nodes.remove(inner.first..inner.first + 2);
        self.relink(parent, &sibling);
        self.refit_above(nodes, parent);
    }

    /// Recomputes the boxes above a node, up to the first that does not change.
    fn refit_above(&mut self, nodes: &mut Pool<RayNode>, mut index: u32) {
        while index != ROOT {
            index = *slot(&mut self.parents, index);
            let old = nodes.get(index);
            let bounds = nodes.get(old.first).bounds().union(&nodes.get(old.first + 1).bounds());
            let node = RayNode::new(&bounds, old.first, 0);
            if node == old {
                return;
            }
            nodes.set(index, node);
            self.inner_area += area(&node) - area(&old);
        }
    }

    /// Frees all nodes but the root.
    fn free(&mut self, nodes: &mut Pool<RayNode>) {
        let mut open = vec![nodes.get(ROOT)];
        while let Some(node) = open.pop() {
            if !node.is_instance() && node.first != 0 {
                open.extend([nodes.get(node.first), nodes.get(node.first + 1)]);
                nodes.remove(node.first..node.first + 2);
            }
        }
    }
}

/// Returns a leaf of a tree that is not empty, and its depth (the root's is 1): the one that is reached by the children whose boxes grow
/// least around `bounds`.
fn sibling(nodes: &Pool<RayNode>, bounds: &Aabb) -> (u32, usize) {
    let (mut index, mut depth) = (ROOT, 1);
    loop {
        let node = nodes.get(index);
        if node.is_instance() {
            return (index, depth);
        }
        let growth = |child: u32| {
            let own = nodes.get(child).bounds();
            (own.union(bounds).half_area() - own.half_area(), own.half_area())
        };
        let is_second = growth(node.first + 1) < growth(node.first);
        (index, depth) = (node.first + u32::from(is_second), depth + 1);
    }
}

/// Returns an element of a list that grows as needed.
fn slot<T: Clone + Default>(list: &mut Vec<T>, index: u32) -> &mut T {
    let index = index as usize;
    if list.len() <= index {
        list.resize(index + 1, T::default());
    }
    &mut list[index]
}
