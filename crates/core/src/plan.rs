//! The plan: the decisions of the compiler and their reasons, as plain data.
//!
//! It keeps the declaration that it was compiled from, and a flat array for each kind of decision. The types with a
//! lifetime are views into these arrays.

mod graph;
mod reasons;
mod serialize;

pub use reasons::{CullReason, LoadReason, MergeReason, OrderReason, SlotReason, StoreReason};

use crate::access::{Access, ClearValue, Contents};
use crate::declaration::{AccessDecl, CopyOp, Declaration, NoteSubject, Options, Origin, PassKind};
use crate::desc::ResourceDesc;
#[cfg(any(feature = "gpu", test))]
use crate::error::Error;
#[cfg(any(feature = "gpu", test))]
use crate::handle::Token;
use crate::handle::{NodeId, PassId, ResourceId, SlotId};
#[cfg(any(feature = "gpu", test))]
use crate::pass_name::SourceLocations;
use crate::subresource::{Region, Subresource};
use serde::Serialize;
use std::sync::atomic::{AtomicU64, Ordering};
use wgpu_types::{BufferUsages, TextureUsages};

/// The compiled form of a frame. Dumps print it; the executor follows it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    pub(crate) decl: Declaration,
    pub(crate) structure: StructureId,
    /// Reason why each pass is culled, by pass.
    pub(crate) culled: Vec<Option<CullReason>>,
    /// The passes that run, in order.
    pub(crate) order: Vec<PassId>,
    /// Reasons why passes are at their positions, by position in the order.
    pub(crate) order_reasons: Vec<OrderReason>,
    /// Reasons why passes are merged or not, by position in the order.
    pub(crate) merge_reasons: Vec<MergeReason>,
    /// Ranges of the order that share a pass of the encoder.
    pub(crate) steps: Vec<(u32, u32)>,
    /// Load and store operations, by access.
    pub(crate) ops: Vec<Option<AttachmentOps>>,
    /// Lifetimes, usages and slots, by resource.
    pub(crate) placements: Vec<Placement>,
    pub(crate) slots: Vec<Slot>,
    /// Resources in slots; each slot has a range of it.
    pub(crate) slot_resources: Vec<ResourceId>,
    pub(crate) dependencies: Vec<Dependency>,
}

/// Identifies plans that differ only in clear values: the same objects fit them. It is not part of what a plan says, so plans
/// with different ones can be equal.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct StructureId(u64);

impl StructureId {
    /// Returns a new one.
    pub(crate) fn new() -> Self {
        static NEXT: AtomicU64 = AtomicU64::new(1);
        Self(NEXT.fetch_add(1, Ordering::Relaxed))
    }

    pub(crate) fn is_same(self, other: Self) -> bool {
        self.0 == other.0
    }
}

impl PartialEq for StructureId {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The lifetime, usages and slot of a resource.
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
    /// Name of the declaration.
    pub name: &'p str,
    /// Node of the pass.
    pub node: Option<NodeId>,
    /// Kind of the pass.
    pub kind: PassKind,
    /// Whether it is kept even if nothing needs what it writes.
    pub keep: bool,
    /// Reason why the pass does not run; `None` if it runs.
    pub culled: Option<CullReason>,
    /// Copies of a copy pass.
    pub copies: &'p [CopyOp],
}

/// One access of a pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AccessPlan {
    /// Accessed resource.
    pub resource: ResourceId,
    /// Accessed subresource.
    #[serde(rename = "part")]
    pub subresource: Subresource,
    /// Kind of access.
    pub access: Access,
    /// Effect of a write on the earlier contents.
    pub contents: Option<Contents>,
    /// Version that is read or overwritten; a write makes `version + 1`.
    pub version: u32,
    /// Load and store operations of attachments in passes that run; `None` for read-only depth.
    pub ops: Option<AttachmentOps>,
    #[serde(skip)]
    pub(crate) region: Region,
}

/// The load and store operations of an attachment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AttachmentOps {
    /// Load operation.
    pub load: LoadAction,
    /// Reason of the load operation.
    pub load_reason: LoadReason,
    /// Whether the graph draws the declared clear, because a load operation would clear the whole attachment.
    pub clear_drawn: bool,
    /// Store operation.
    pub store: StoreAction,
    /// Reason of the store operation.
    pub store_reason: StoreReason,
}

/// The contents of an attachment when the pass begins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum LoadAction {
    /// Cleared to this value.
    Clear(ClearValue),
    /// Loaded from memory.
    Load,
    /// Continued from earlier passes of the same render pass.
    Continue,
}

/// Operation on an attachment when the pass ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum StoreAction {
    /// Written to memory.
    Store,
    /// Discarded.
    Discard,
    /// Continued by the next pass of the same render pass.
    Continue,
}

/// One declared resource.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ResourcePlan<'p> {
    /// Name of the declaration.
    pub name: &'p str,
    /// Node that declared it.
    pub node: Option<NodeId>,
    /// Description of the resource.
    pub desc: ResourceDesc,
    /// Origin of the resource.
    pub origin: Origin,
    /// Whether it is exported.
    pub exported: bool,
    /// Texture usages that passes which run need.
    pub texture_usage: TextureUsages,
    /// Buffer usages that passes which run need.
    pub buffer_usage: BufferUsages,
    /// First and last step that uses it; `None` if no pass that runs does.
    pub steps: Option<(u32, u32)>,
    /// Slot of the resource; `None` if it is not transient or not used.
    pub slot: Option<SlotId>,
    /// Reason for the slot, or for none.
    pub slot_reason: SlotReason,
}

/// A physical texture or buffer.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlotPlan<'p> {
    /// Description of the slot. A buffer has the size of its class, at least that of every resource in it.
    pub desc: ResourceDesc,
    /// Texture usages of all resources in the slot.
    pub texture_usage: TextureUsages,
    /// Buffer usages of all resources in the slot.
    pub buffer_usage: BufferUsages,
    /// Resources that share the slot, in order of use.
    #[serde(rename = "tenants")]
    pub resources: &'p [ResourceId],
}

/// One step of the recording: its passes share one pass of the encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Step<'p> {
    /// Passes in order, at least one.
    pub passes: &'p [PassId],
}

/// A dependency: one pass must run before another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub struct Dependency {
    /// The earlier pass.
    pub before: PassId,
    /// The later pass.
    pub after: PassId,
    /// Resource that causes the dependency; `None` for an explicit order.
    pub resource: Option<ResourceId>,
    /// Kind of hazard.
    pub kind: DependencyKind,
}

/// Reason why two passes are ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
pub enum DependencyKind {
    /// The later one reads what the earlier one wrote.
    ReadAfterWrite,
    /// The later one overwrites what the earlier one reads.
    WriteAfterRead,
    /// The later one overwrites what the earlier one wrote.
    WriteAfterWrite,
    /// The order was declared by [`Pass::after`](crate::Pass::after).
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

    /// Returns whether two plans differ at most in the values that passes clear textures with.
    pub fn has_structure_of(&self, other: &Self) -> bool {
        self.structure.is_same(other.structure) || self == other
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

    /// Returns the physical textures and buffers that transient resources share.
    pub fn slots(&self) -> impl ExactSizeIterator<Item = SlotPlan<'_>> {
        self.slots.iter().map(|slot| SlotPlan {
            desc: slot.desc,
            texture_usage: slot.texture_usage,
            buffer_usage: slot.buffer_usage,
            resources: &self.slot_resources[slot.resources.0 as usize..slot.resources.1 as usize],
        })
    }

    /// Returns the steps, in order.
    pub fn steps(&self) -> impl DoubleEndedIterator<Item = Step<'_>> + ExactSizeIterator {
        self.steps.iter().map(|&(start, end)| Step { passes: &self.order[start as usize..end as usize] })
    }

    /// Returns the passes that run, in order.
    pub fn order(&self) -> &[PassId] {
        &self.order
    }

    /// Returns the dependencies between passes that run.
    pub fn dependencies(&self) -> &[Dependency] {
        &self.dependencies
    }

    /// Returns the options of the frame.
    pub fn options(&self) -> Options {
        self.decl.options
    }

    /// Returns the pass.
    ///
    /// # Panics
    /// If the id is out of range for this plan.
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

    /// Returns the accesses of the pass, in order of declaration.
    ///
    /// # Panics
    /// If the id is out of range for this plan.
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
    /// If the id is out of range for this plan.
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

    /// Returns why the pass is at its position in the order; `None` if it is culled.
    pub fn order_reason(&self, id: PassId) -> Option<OrderReason> {
        self.position(id).map(|position| self.order_reasons[position])
    }

    /// Returns why the pass was merged into the render pass before it, or why not; `None` if it is culled.
    pub fn merge_reason(&self, id: PassId) -> Option<MergeReason> {
        self.position(id).map(|position| self.merge_reasons[position])
    }

    fn position(&self, id: PassId) -> Option<usize> {
        self.order.iter().position(|&pass| pass == id)
    }

    /// Returns the last pass declared as `name`, without its nodes.
    pub fn find_pass(&self, name: &str) -> Option<PassId> {
        self.passes().rev().find(|(_, pass)| pass.name == name).map(|(id, _)| id)
    }

    /// Returns the last resource declared as `name`.
    pub fn find_resource(&self, name: &str) -> Option<ResourceId> {
        self.resources().rev().find(|(_, resource)| resource.name == name).map(|(id, _)| id)
    }

    /// Returns the notes of the declaration about a pass.
    pub fn pass_notes(&self, id: PassId) -> impl Iterator<Item = &str> {
        self.notes_about(NoteSubject::Pass(id))
    }

    /// Returns the notes of the declaration about a resource.
    pub fn resource_notes(&self, id: ResourceId) -> impl Iterator<Item = &str> {
        self.notes_about(NoteSubject::Resource(id))
    }

    fn notes_about(&self, subject: NoteSubject) -> impl Iterator<Item = &str> {
        let notes = self.decl.notes.iter().filter(move |note| note.subject == subject);
        notes.map(|note| self.decl.names.get(note.text))
    }

    /// Returns the pass's path: its name after those of its nodes, such as `post/blur`.
    pub fn pass_path(&self, id: PassId) -> String {
        self.decl.pass_path(id)
    }

    /// Returns the resource's path: its name after those of the nodes that declared it, such as `post/half`.
    pub fn resource_path(&self, id: ResourceId) -> String {
        self.decl.resource_path(id)
    }

    /// Returns the node's path: its name after those of the nodes around it.
    pub fn node_path(&self, id: NodeId) -> String {
        let mut path = String::new();
        self.decl.write_node_path(id, &mut path);
        path
    }

    /// Returns the total bytes of all slots.
    pub fn slot_bytes(&self) -> u64 {
        self.slots.iter().map(|slot| slot.desc.bytes()).sum()
    }

    /// Returns the bytes saved by sharing slots, compared to one slot for each resource.
    pub fn saved_bytes(&self) -> u64 {
        let saved = |slot: &Slot| {
            slot.desc.bytes() * u64::from((slot.resources.1 - slot.resources.0).saturating_sub(1))
        };
        self.slots.iter().map(saved).sum()
    }

    /// Returns the resource of a token used in `pass`: only tokens of that pass resolve. `places` are those of the frame.
    #[cfg(any(feature = "gpu", test))]
    pub(crate) fn resolve(
        &self,
        (frame, places): (u64, &SourceLocations),
        pass: PassId,
        token: Token,
    ) -> Result<ResourceId, Error> {
        let name = |pass| self.decl.pass_name_at(pass, places);
        let index = token.access as usize;
        match self.decl.accesses.get(index).filter(|_| token.is_of(frame)) {
            None => Err(Error::ForeignHandle { location: format!("pass {}", name(pass)) }),
            Some(access) if self.decl.access_range(pass).contains(&index) => Ok(access.resource),
            Some(access) => {
                let declared_by =
                    self.decl.pass_ids().find(|&id| self.decl.access_range(id).contains(&index));
                Err(Error::Undeclared {
                    pass: name(pass),
                    resource: self.resource(access.resource).name.into(),
                    declared_by: declared_by.map(name).unwrap_or_default(),
                })
            }
        }
    }
}
