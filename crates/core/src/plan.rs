//! The plan: what will be done and why, as plain data.
//!
//! It keeps the declaration it was made from and, beside it, one flat array for each decision. The types with a
//! lifetime are views into these arrays.

mod graph;
mod reasons;
mod serialize;

pub use reasons::{CullReason, LoadReason, MergeReason, OrderReason, SlotReason, StoreReason};

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{AccessDecl, CopyOp, Declaration, Options, Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId, SlotId};
use crate::subresource::{Region, Subresource};
use serde::Serialize;
use wgpu_types::{BufferUsages, TextureUsages};

/// What a frame's declarations come to. The dumps print it; the executor follows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    pub(crate) decl: Declaration,
    /// By pass.
    pub(crate) culled: Vec<Option<CullReason>>,
    /// The passes that run, in order.
    pub(crate) order: Vec<PassId>,
    /// By place in the order.
    pub(crate) order_reasons: Vec<OrderReason>,
    /// By place in the order.
    pub(crate) merge_reasons: Vec<MergeReason>,
    /// Runs of the order.
    pub(crate) steps: Vec<(u32, u32)>,
    /// By access.
    pub(crate) ops: Vec<Option<AttachmentOps>>,
    /// By resource.
    pub(crate) placements: Vec<Placement>,
    pub(crate) slots: Vec<Slot>,
    /// Runs of it belong to slots.
    pub(crate) slot_resources: Vec<ResourceId>,
    pub(crate) dependencies: Vec<Dependency>,
}

/// What becomes of a resource.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    pub(crate) texture_usage: TextureUsages,
    pub(crate) buffer_usage: BufferUsages,
    pub(crate) steps: Option<(u32, u32)>,
    pub(crate) slot: Option<SlotId>,
    pub(crate) reason: SlotReason,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Slot {
    pub(crate) desc: ResourceDesc,
    pub(crate) texture_usage: TextureUsages,
    pub(crate) buffer_usage: BufferUsages,
    pub(crate) resources: (u32, u32),
}

/// A named group of passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct NodePlan<'p> {
    /// The name given to `Frame::node`.
    pub name: &'p str,
    /// The node around this one.
    pub parent: Option<NodeId>,
}

/// One declared pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct PassPlan<'p> {
    /// The name it was declared under.
    pub name: &'p str,
    /// The node it belongs to.
    pub node: Option<NodeId>,
    /// What it is made of.
    pub kind: PassKind,
    /// Whether it stays even if nothing needs what it writes.
    pub keep: bool,
    /// Why it does not run; `None` if it runs.
    pub culled: Option<CullReason>,
    /// The transfers of a copy pass.
    pub copies: &'p [CopyOp],
}

/// One access of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AccessPlan {
    /// What is touched.
    pub resource: ResourceId,
    /// Which part of it.
    #[serde(rename = "part")]
    pub subresource: Subresource,
    /// How.
    pub access: Access,
    /// For writes: what becomes of the earlier contents.
    pub contents: Option<Contents>,
    /// The version read or written over; a write makes `version + 1`.
    pub version: u32,
    /// For attachments, in passes that run: what happens at the pass's begin and end. `None` also for depth that is
    /// only tested.
    pub ops: Option<AttachmentOps>,
    #[serde(skip)]
    pub(crate) region: Region,
}

/// What happens to an attachment at the begin and the end of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AttachmentOps {
    /// At the begin.
    pub load: LoadAction,
    /// Why so.
    pub load_reason: LoadReason,
    /// Whether the graph draws the declared clear into the part, since a load operation would clear all of the
    /// attachment.
    pub clear_drawn: bool,
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
    /// What the passes before it drew in the same render pass.
    Continue,
}

/// What becomes of an attachment when the pass ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum StoreAction {
    /// It is written to memory.
    Store,
    /// It may be forgotten.
    Discard,
    /// The next pass draws on in the same render pass.
    Continue,
}

/// One declared resource.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResourcePlan<'p> {
    /// The name it was declared under.
    pub name: &'p str,
    /// The node that declared it.
    pub node: Option<NodeId>,
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
    /// The slot it lives in; `None` for what is not transient and for what nothing touches.
    pub slot: Option<SlotId>,
    /// Why it lives there.
    pub slot_reason: SlotReason,
}

/// A physical texture or buffer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlotPlan<'p> {
    /// Its shape. Of a buffer, the size class: at least as large as every tenant.
    pub desc: ResourceDesc,
    /// For textures: the usages of all tenants together.
    pub texture_usage: TextureUsages,
    /// For buffers: the usages of all tenants together.
    pub buffer_usage: BufferUsages,
    /// The resources that take turns in it, first one first.
    #[serde(rename = "tenants")]
    pub resources: &'p [ResourceId],
}

/// One step of the recording: the passes in it share one pass of the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Step<'p> {
    /// In order; at least one.
    pub passes: &'p [PassId],
}

/// One pass must come before another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Dependency {
    /// The earlier pass.
    pub before: PassId,
    /// The later pass.
    pub after: PassId,
    /// For the sake of this resource; `None` where the order was asked for by name.
    pub resource: Option<ResourceId>,
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
    /// The frame says so: [`Pass::after`](crate::Pass::after).
    Explicit,
}

impl Plan {
    /// Returns how many passes were declared.
    pub fn pass_count(&self) -> usize {
        self.decl.passes.len()
    }

    /// Returns how many passes do not run.
    pub fn culled_count(&self) -> usize {
        self.decl.passes.len() - self.order.len()
    }

    /// Returns every declared pass, culled ones too, in order of declaration.
    pub fn passes(&self) -> impl DoubleEndedIterator<Item = (PassId, PassPlan<'_>)> + ExactSizeIterator {
        (0..self.decl.passes.len()).map(|index| PassId(index as u32)).map(|id| (id, self.pass(id)))
    }

    /// Returns every declared resource, in order of declaration.
    pub fn resources(
        &self,
    ) -> impl DoubleEndedIterator<Item = (ResourceId, ResourcePlan<'_>)> + ExactSizeIterator {
        (0..self.decl.resources.len()).map(|index| ResourceId(index as u32)).map(|id| (id, self.resource(id)))
    }

    /// Returns the groups of passes, in order of declaration.
    pub fn nodes(&self) -> impl ExactSizeIterator<Item = NodePlan<'_>> {
        self.decl
            .nodes
            .iter()
            .map(|node| NodePlan { name: self.decl.names.get(node.name), parent: node.parent })
    }

    /// Returns the physical textures and buffers that transient resources take turns in.
    pub fn slots(&self) -> impl ExactSizeIterator<Item = SlotPlan<'_>> {
        self.slots.iter().map(|slot| SlotPlan {
            desc: slot.desc,
            texture_usage: slot.texture_usage,
            buffer_usage: slot.buffer_usage,
            resources: &self.slot_resources[slot.resources.0 as usize..slot.resources.1 as usize],
        })
    }

    /// Returns what is recorded, in order.
    pub fn steps(&self) -> impl DoubleEndedIterator<Item = Step<'_>> + ExactSizeIterator {
        self.steps.iter().map(|&(start, end)| Step { passes: &self.order[start as usize..end as usize] })
    }

    /// Returns the passes that run, in order.
    pub fn order(&self) -> &[PassId] {
        &self.order
    }

    /// Returns which pass must come before which, and for the sake of what, among the passes that run.
    pub fn dependencies(&self) -> &[Dependency] {
        &self.dependencies
    }

    /// Returns what the compiler was allowed to do.
    pub fn options(&self) -> Options {
        self.decl.options
    }

    /// Returns the pass.
    ///
    /// # Panics
    /// With an id that is not of this plan, as an index past the end of a list would.
    pub fn pass(&self, id: PassId) -> PassPlan<'_> {
        let pass = self.decl.pass(id);
        PassPlan {
            name: self.decl.names.get(pass.name),
            node: pass.node,
            kind: pass.kind,
            keep: pass.keep,
            culled: self.culled[id.index()],
            copies: self.decl.copies(id),
        }
    }

    /// Returns everything that the pass touches, in order of declaration.
    ///
    /// # Panics
    /// With an id that is not of this plan, as an index past the end of a list would.
    pub fn accesses(
        &self,
        id: PassId,
    ) -> impl DoubleEndedIterator<Item = AccessPlan> + ExactSizeIterator + Clone + '_ {
        self.decl.access_range(id).map(|index| self.access(index))
    }

    pub(crate) fn access(&self, index: usize) -> AccessPlan {
        let access: &AccessDecl = &self.decl.accesses[index];
        AccessPlan {
            resource: access.resource,
            subresource: self.decl.subresource(access),
            access: access.access,
            contents: self.decl.contents(access),
            version: access.version,
            ops: self.ops[index],
            region: self.decl.region(access).copied().unwrap_or(Region::ALL),
        }
    }

    /// Returns the resource.
    ///
    /// # Panics
    /// With an id that is not of this plan, as an index past the end of a list would.
    pub fn resource(&self, id: ResourceId) -> ResourcePlan<'_> {
        let resource = self.decl.resource(id);
        let placement = &self.placements[id.index()];
        ResourcePlan {
            name: self.decl.names.get(resource.name),
            node: resource.node,
            desc: resource.desc,
            origin: resource.origin,
            exported: resource.exported.is_some(),
            texture_usage: placement.texture_usage,
            buffer_usage: placement.buffer_usage,
            steps: placement.steps,
            slot: placement.slot,
            slot_reason: placement.reason,
        }
    }

    /// Returns why the pass stands where it does in the order; `None` if it is culled.
    pub fn order_reason(&self, id: PassId) -> Option<OrderReason> {
        self.place(id).map(|place| self.order_reasons[place])
    }

    /// Returns why the pass was merged into the render pass before it, or why not; `None` if it is culled.
    pub fn merge_reason(&self, id: PassId) -> Option<MergeReason> {
        self.place(id).map(|place| self.merge_reasons[place])
    }

    fn place(&self, id: PassId) -> Option<usize> {
        self.order.iter().position(|&pass| pass == id)
    }

    /// Returns the pass declared last under `name`, without its nodes.
    pub fn find_pass(&self, name: &str) -> Option<PassId> {
        self.passes().rev().find(|(_, pass)| pass.name == name).map(|(id, _)| id)
    }

    /// Returns the resource declared last under `name`.
    pub fn find_resource(&self, name: &str) -> Option<ResourceId> {
        self.resources().rev().find(|(_, resource)| resource.name == name).map(|(id, _)| id)
    }

    /// Returns the pass's name with its nodes before it, such as `post/blur`.
    pub fn pass_path(&self, id: PassId) -> String {
        self.decl.pass_path(id)
    }

    /// Returns the resource's name with the nodes that it was declared in before it, such as `post/half`.
    pub fn resource_path(&self, id: ResourceId) -> String {
        self.decl.resource_path(id)
    }

    /// Returns the node's name with the nodes around it before it.
    pub fn node_path(&self, id: NodeId) -> String {
        let mut path = String::new();
        self.decl.write_node_path(id, &mut path);
        path
    }

    /// Returns the bytes of all slots together.
    pub fn slot_bytes(&self) -> u64 {
        self.slots.iter().map(|slot| slot.desc.bytes()).sum()
    }

    /// Returns the bytes that sharing slots saves, against one slot for each resource.
    pub fn saved_bytes(&self) -> u64 {
        let alone = |slot: &Slot| {
            slot.desc.bytes() * u64::from((slot.resources.1 - slot.resources.0).saturating_sub(1))
        };
        self.slots.iter().map(alone).sum()
    }
}
