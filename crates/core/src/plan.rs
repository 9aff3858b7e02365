//! The plan: what will be done and why, as plain data.

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{CopyOp, Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId, SlotId};
use petgraph::graph::DiGraph;
use serde::Serialize;
use wgpu_types::{BufferUsages, TextureUsages};

/// What a frame's declarations come to. The dumps print it; the executor follows it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Plan {
    /// Groups of passes, in order of declaration.
    pub nodes: Vec<NodePlan>,
    /// Every declared pass, culled ones too, in order of declaration.
    pub passes: Vec<PassPlan>,
    /// Every declared resource, in order of declaration.
    pub resources: Vec<ResourcePlan>,
    /// The physical textures and buffers that transient resources take turns in.
    pub slots: Vec<SlotPlan>,
    /// What is recorded, in this order.
    pub order: Vec<Step>,
    /// Which pass must come before which, and for the sake of what.
    pub dependencies: Vec<Dependency>,
}

/// A named group of passes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct NodePlan {
    /// The name given to `Frame::node`.
    pub name: String,
    /// The node around this one.
    pub parent: Option<NodeId>,
}

/// One declared pass.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PassPlan {
    /// The name it was declared under.
    pub name: String,
    /// The node it belongs to.
    pub node: Option<NodeId>,
    /// What it is made of.
    pub kind: PassKind,
    /// Everything it touches.
    pub accesses: Vec<AccessPlan>,
    /// The transfers of a copy pass.
    pub copies: Vec<CopyOp>,
    /// Why it does not run; `None` if it runs.
    pub culled: Option<CullReason>,
}

/// One access of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AccessPlan {
    /// What is touched.
    pub resource: ResourceId,
    /// How.
    pub access: Access,
    /// For writes: what becomes of the earlier contents.
    pub contents: Option<Contents>,
    /// The version read or written over; a write makes `version + 1`.
    pub version: u32,
    /// For attachments that are written, in passes that run: what happens at the pass's begin and end.
    pub ops: Option<AttachmentOps>,
}

/// What happens to an attachment at the begin and the end of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AttachmentOps {
    /// At the begin.
    pub load: LoadAction,
    /// Why so.
    pub load_reason: LoadReason,
    /// At the end.
    pub store: StoreAction,
    /// Why so.
    pub store_reason: StoreReason,
}

/// What an attachment holds when the pass begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum LoadAction {
    /// This value.
    Clear(ClearValue),
    /// What it held before.
    Load,
}

/// Why an attachment is cleared or loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum LoadReason {
    /// The pass declares the clear.
    Declared,
    /// The pass covers every texel, and a clear is the cheapest load there is.
    Covered,
    /// The pass preserves what this pass wrote.
    Preserves(PassId),
    /// The pass preserves what the caller's texture held.
    PreservesImport,
}

/// What becomes of an attachment when the pass ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum StoreAction {
    /// It is written to memory.
    Store,
    /// It may be forgotten.
    Discard,
}

/// Why an attachment is stored or discarded.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum StoreReason {
    /// This pass needs it.
    NeededBy(PassId),
    /// It is exported.
    Exported,
    /// It belongs to the caller.
    Imported,
    /// This pass overwrites it before anything reads it.
    OverwrittenBy(PassId),
    /// Nothing touches it any more.
    LastUse,
}

/// Why a pass does not run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum CullReason {
    /// It writes nothing and is not kept.
    WritesNothing,
    /// Nothing reads what it writes.
    Unread(ResourceId),
    /// Only passes that are culled themselves, such as this one, read what it writes.
    OnlyCulledReaders(ResourceId, PassId),
    /// The second overwrites the first before anything reads it.
    Overwritten(ResourceId, PassId),
}

/// One declared resource.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResourcePlan {
    /// The name it was declared under.
    pub name: String,
    /// Its shape.
    pub desc: ResourceDesc,
    /// Where it comes from.
    pub origin: Origin,
    /// Whether it is taken out of the frame.
    pub exported: bool,
    /// For textures: the usages that passes which run need.
    pub texture_usage: TextureUsages,
    /// For buffers: the usages that passes which run need.
    pub buffer_usage: BufferUsages,
    /// First and last step that touches it; `None` if nothing that runs does.
    pub steps: Option<(u32, u32)>,
    /// The slot it lives in; `None` for imports and for what nothing touches.
    pub slot: Option<SlotId>,
}

/// A physical texture or buffer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlotPlan {
    /// Its shape.
    pub desc: ResourceDesc,
    /// For textures: the usages of all tenants together.
    pub texture_usage: TextureUsages,
    /// For buffers: the usages of all tenants together.
    pub buffer_usage: BufferUsages,
    /// The resources that take turns in it, first one first.
    pub tenants: Vec<ResourceId>,
}

/// One step of the recording: the passes in it share one pass of the encoder.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Step {
    /// In order; at least one.
    pub passes: Vec<PassId>,
}

/// One pass must come before another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Dependency {
    /// The earlier pass.
    pub before: PassId,
    /// The later pass.
    pub after: PassId,
    /// For the sake of this resource.
    pub resource: ResourceId,
    /// Which hazard it is.
    pub kind: DependencyKind,
}

/// Why two passes are ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum DependencyKind {
    /// The later one reads what the earlier one wrote.
    ReadAfterWrite,
    /// The later one overwrites what the earlier one reads.
    WriteAfterRead,
    /// The later one overwrites what the earlier one wrote.
    WriteAfterWrite,
}

impl Plan {
    /// Returns the dependencies as a graph whose node indices are pass ids, for petgraph's algorithms.
    ///
    /// ```
    /// use petgraph::algo::is_cyclic_directed;
    /// let plan = shadowgraph_core::Frame::new().compile()?.into_plan();
    /// assert!(!is_cyclic_directed(&plan.graph()));
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn graph(&self) -> DiGraph<PassId, Dependency> {
        let mut graph = DiGraph::with_capacity(self.passes.len(), self.dependencies.len());
        for index in 0..self.passes.len() {
            graph.add_node(PassId(index as u32));
        }
        for &dependency in &self.dependencies {
            graph.add_edge(dependency.before.0.into(), dependency.after.0.into(), dependency);
        }
        graph
    }

    /// Returns the pass.
    pub fn pass(&self, id: PassId) -> &PassPlan {
        &self.passes[id.index()]
    }

    /// Returns the resource.
    pub fn resource(&self, id: ResourceId) -> &ResourcePlan {
        &self.resources[id.index()]
    }

    /// Returns the passes that run, in order.
    pub fn live_passes(&self) -> impl Iterator<Item = PassId> + '_ {
        self.order.iter().flat_map(|step| step.passes.iter().copied())
    }

    /// Returns the pass's name with its nodes before it, such as `post/blur`.
    pub fn pass_path(&self, id: PassId) -> String {
        let mut path = String::new();
        self.write_pass_path(id, &mut path);
        path
    }

    /// Returns the node's name with the nodes around it before it.
    pub fn node_path(&self, id: NodeId) -> String {
        let mut path = String::new();
        self.write_node_path(id, &mut path);
        path
    }

    /// Appends what [`pass_path`](Self::pass_path) returns.
    pub(crate) fn write_pass_path(&self, id: PassId, path: &mut String) {
        let pass = self.pass(id);
        if let Some(node) = pass.node {
            self.write_node_path(node, path);
            path.push('/');
        }
        path.push_str(&pass.name);
    }

    fn write_node_path(&self, id: NodeId, path: &mut String) {
        let node = &self.nodes[id.index()];
        if let Some(parent) = node.parent {
            self.write_node_path(parent, path);
            path.push('/');
        }
        path.push_str(&node.name);
    }

    /// Returns the bytes of all slots together.
    pub fn slot_bytes(&self) -> u64 {
        self.slots.iter().map(|slot| slot.desc.bytes()).sum()
    }

    /// Returns the bytes that sharing slots saves, against one slot for each resource.
    pub fn saved_bytes(&self) -> u64 {
        let alone = |slot: &SlotPlan| slot.desc.bytes() * (slot.tenants.len() as u64 - 1);
        self.slots.iter().map(alone).sum()
    }
}
