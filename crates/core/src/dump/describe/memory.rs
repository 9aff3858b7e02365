//! Describes why attachments are loaded, cleared, stored and discarded, and why resources share slots.

use super::clear;
use crate::access::{Access, Contents};
use crate::desc::ResourceDesc;
use crate::handle::{PassId, ResourceId};
use crate::plan::{
    AccessPlan, AttachmentOps, LoadAction, LoadReason, Plan, SlotReason, StoreAction, StoreReason,
};
use wgpu_types::TextureUsages;

impl Plan {
    /// Describes the load operation of an attachment, and its reason.
    pub fn describe_load(&self, ops: &AttachmentOps) -> (String, String) {
        let action = match ops.load {
            LoadAction::Clear(value) => clear(value),
            LoadAction::Load => "load".into(),
            LoadAction::Continue => "continue".into(),
        };
        let reason = match ops.load_reason {
            LoadReason::Declared => "the pass clears it".into(),
            LoadReason::Overwritten => "the pass overwrites it, and a clear costs less than a load".into(),
            LoadReason::Preserves(pass) => {
                format!("the pass preserves what `{}` wrote", self.pass_path(pass))
            }
            LoadReason::PreservesImport => "the pass preserves the contents from before the frame".into(),
            LoadReason::RestUnneeded => "nothing needs the rest, and a clear costs less than a load".into(),
            LoadReason::RestNeededBy(pass) => format!("`{}` needs the rest of it", self.pass_path(pass)),
            LoadReason::RestOutlives => "the rest of it is needed after the frame".into(),
            LoadReason::Merged => "it continues the render pass of the previous pass".into(),
        };
        (action, reason)
    }

    /// Describes the store operation of an attachment, and its reason.
    pub fn describe_store(&self, ops: &AttachmentOps) -> (&'static str, String) {
        let action = match ops.store {
            StoreAction::Store => "store",
            StoreAction::Discard => "discard",
            StoreAction::Continue => "continue",
        };
        let reason = match ops.store_reason {
            StoreReason::NeededBy(pass) => format!("`{}` needs it", self.pass_path(pass)),
            StoreReason::Exported => "it is exported".into(),
            StoreReason::Imported => "it belongs to the caller".into(),
            StoreReason::History => "the next frame reads it as history".into(),
            StoreReason::Merged => "the next pass continues the render pass".into(),
            StoreReason::OverwrittenBy(pass) => {
                format!("`{}` overwrites it before anything reads it", self.pass_path(pass))
            }
            StoreReason::LastUse => "nothing reads it after this".into(),
        };
        (action, reason)
    }

    /// Explains the load operation of an access, which may be to a part of the attachment.
    pub fn explain_load(&self, access: &AccessPlan, ops: &AttachmentOps) -> (String, String) {
        let (action, reason) = self.describe_load(ops);
        let in_part = access.region != access.region.without_rect();
        match ops.load_reason {
            LoadReason::Declared if in_part => {
                (action, "the pass clears its part, and nothing needs the rest".into())
            }
            LoadReason::Merged if self.explain_done_clear(access, ops).is_some() => {
                (action, "it continues the render pass, which began with this clear".into())
            }
            _ => (action, reason),
        }
    }

    /// Explains the store operation of an access, which may be resolved.
    pub fn explain_store(
        &self,
        pass: PassId,
        access: &AccessPlan,
        ops: &AttachmentOps,
    ) -> (&'static str, String) {
        let (action, reason) = self.describe_store(ops);
        match (ops.store_reason, access.access) {
            (StoreReason::LastUse, Access::Color(index))
                if self.accesses(pass).any(|a| a.access == Access::Resolve(index)) =>
            {
                (action, "it is resolved, and nothing reads the samples after this".into())
            }
            _ => (action, reason),
        }
    }

    /// Explains a clear inside a render pass that the load operation at its begin has done.
    pub(in crate::dump) fn explain_done_clear(
        &self,
        access: &AccessPlan,
        ops: &AttachmentOps,
    ) -> Option<(String, &'static str)> {
        let Some(Contents::Clear(value)) = access.contents else { return None };
        let done = ops.load == LoadAction::Continue && !ops.clear_drawn;
        done.then(|| (clear(value), "the render pass began with it"))
    }

    /// Explains a clear that the graph draws before the pass because a load operation cannot do it.
    pub fn explain_drawn_clear(&self, access: &AccessPlan, ops: &AttachmentOps) -> Option<(String, String)> {
        let Some(Contents::Clear(value)) = access.contents else { return None };
        let why = match ops.load {
            LoadAction::Continue => "the render pass has begun, so a load operation cannot clear",
            _ => "a load operation would clear the whole attachment",
        };
        ops.clear_drawn.then(|| (format!("{}, drawn", clear(value)), why.into()))
    }

    /// Describes why a resource is in its slot, or in none.
    pub fn describe_slot(&self, reason: SlotReason) -> String {
        match reason {
            SlotReason::FirstOfClass => "it is in the first slot of its kind".into(),
            SlotReason::AllBusy(other) => {
                format!("no slot of its kind was free: `{}` holds one", self.resource(other).name)
            }
            _ => self.describe_other_slot(reason),
        }
    }

    /// Explains the slot of a resource, with the kind of slot that it needs.
    pub fn explain_slot(&self, id: ResourceId) -> String {
        let (slot, shape) = self.slot_kind(id);
        match self.resource(id).slot_reason {
            SlotReason::FirstOfClass => format!("the first {slot} of its {shape}"),
            SlotReason::AllBusy(other) => {
                format!("no {slot} of its {shape} was free: `{}` holds one", self.resource(other).name)
            }
            reason => self.describe_other_slot(reason),
        }
    }

    fn describe_other_slot(&self, reason: SlotReason) -> String {
        match reason {
            SlotReason::Unused => "nothing that runs touches it".into(),
            SlotReason::Imported => "it belongs to the caller".into(),
            SlotReason::History => "it is one half of a history".into(),
            SlotReason::After(other) => format!("reuses slot of `{}`", self.resource(other).name),
            SlotReason::FirstOfClass | SlotReason::AllBusy(_) => self.describe_slot(reason),
        }
    }

    /// Returns the kind of slot that a resource can share: the same shape is not enough.
    fn slot_kind(&self, id: ResourceId) -> (&'static str, &'static str) {
        let resource = self.resource(id);
        let usage = resource.texture_usage;
        match resource.desc {
            ResourceDesc::Buffer(_) => ("slot", "size"),
            _ if usage.contains(TextureUsages::TRANSIENT_ATTACHMENT) => ("transient slot", "shape"),
            _ if usage.contains(TextureUsages::STORAGE_BINDING) => ("storage slot", "shape"),
            ResourceDesc::Texture(_) => ("slot", "shape"),
        }
    }
}
