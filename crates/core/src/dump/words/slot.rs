//! Why resources live where they do.

use crate::desc::ResourceDesc;
use crate::handle::ResourceId;
use crate::plan::{Plan, SlotReason};
use wgpu_types::TextureUsages;

impl Plan {
    /// Says why a resource lives where it does.
    pub fn describe_slot(&self, reason: SlotReason) -> String {
        match reason {
            SlotReason::FirstOfClass => "it is in the first slot of its kind".into(),
            SlotReason::AllBusy(other) => {
                format!("no slot of its kind was free: `{}` holds one", self.resource(other).name)
            }
            _ => self.other_slot_words(reason),
        }
    }

    /// [`describe_slot`](Self::describe_slot) of a resource, with the kind of slot that it needs.
    pub(in crate::dump) fn explain_slot(&self, id: ResourceId) -> String {
        let (slot, shape) = self.slot_kind(id);
        match self.resource(id).slot_reason {
            SlotReason::FirstOfClass => format!("the first {slot} of its {shape}"),
            SlotReason::AllBusy(other) => {
                format!("no {slot} of its {shape} was free: `{}` holds one", self.resource(other).name)
            }
            reason => self.other_slot_words(reason),
        }
    }

    fn other_slot_words(&self, reason: SlotReason) -> String {
        match reason {
            SlotReason::Unused => "nothing that runs touches it".into(),
            SlotReason::Imported => "it belongs to the caller".into(),
            SlotReason::History => "it is one half of a history".into(),
            SlotReason::After(other) => format!("takes over from `{}`", self.resource(other).name),
            SlotReason::FirstOfClass | SlotReason::AllBusy(_) => self.describe_slot(reason),
        }
    }

    /// What shares slots with what: shape alone is not enough.
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
