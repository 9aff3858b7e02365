//! Resources by slot; then imports, histories and unused resources.

use crate::declaration::Origin;
use crate::desc::ResourceDesc;
use crate::dump::describe::{bytes, clip, shape, steps, usage};
use crate::handle::ResourceId;
use crate::plan::{Plan, ResourcePlan, SlotReason};
use std::fmt::Write as _;

impl Plan {
    pub(super) fn write_resources(&self, out: &mut String) {
        if self.resources().len() == 0 {
            return;
        }
        out.push_str("\nresources by slot\n");
        for (index, slot) in self.slots().enumerate() {
            let why = slot.resources.first().map(|&first| self.explain_slot(first)).unwrap_or_default();
            write_heading(out, &format!("slot {index}"), &slot.desc, &bytes(slot.desc.bytes()), &why);
            for &resource in slot.resources {
                self.write_slot_resource(out, resource);
            }
        }
        let is = |kind: fn(Origin) -> bool| self.resources().filter(move |(_, r)| kind(r.origin));
        for (id, resource) in is(|origin| matches!(origin, Origin::Imported { .. })) {
            let size = bytes(resource.desc.bytes());
            write_heading(out, "import", &resource.desc, &size, "it belongs to the caller");
            self.write_slot_resource(out, id);
        }
        for (id, resource) in is(|origin| matches!(origin, Origin::Previous { .. } | Origin::Current { .. }))
        {
            if let Origin::Previous { history } = resource.origin {
                let size = format!("2 x {}", bytes(resource.desc.bytes()));
                let why = "the graph keeps two and swaps them each frame";
                write_heading(out, &format!("history {history}"), &resource.desc, &size, why);
            }
            self.write_slot_resource(out, id);
        }
        self.write_unused(out);
    }

    fn write_slot_resource(&self, out: &mut String, id: ResourceId) {
        let resource = self.resource(id);
        let _ = writeln!(
            out,
            "    {:<24} {:<14} {:<25}  {}",
            clip(resource.name, 24),
            steps(&resource),
            usage(&resource),
            self.resource_notes(id, &resource).join("; "),
        );
    }

    fn resource_notes(&self, id: ResourceId, resource: &ResourcePlan<'_>) -> Vec<String> {
        let mut notes = Vec::new();
        if resource.exported {
            notes.push("exported".into());
        }
        if let SlotReason::After(_) = resource.slot_reason {
            notes.push(self.explain_slot(id));
        }
        if let (ResourceDesc::Buffer(own), Some(slot)) = (resource.desc, resource.slot)
            && own.bytes != self.slots[slot.index()].desc.bytes()
        {
            notes.push(format!("needs {}", bytes(own.bytes)));
        }
        notes
    }

    fn write_unused(&self, out: &mut String) {
        let of_frame = |origin: Origin| origin == Origin::Transient;
        let unused = |r: &ResourcePlan<'_>| of_frame(r.origin) && r.slot.is_none();
        let mut unused = self.resources().filter(|(_, r)| unused(r)).peekable();
        if let Some((id, _)) = unused.peek() {
            let _ = writeln!(out, "  no slot: {}", self.explain_slot(*id));
        }
        for (_, resource) in unused {
            let _ = writeln!(out, "    {:<24} {}", clip(resource.name, 24), shape(&resource.desc));
        }
    }
}

/// Writes the heading of a slot, import or history: shape, size and reason.
fn write_heading(out: &mut String, name: &str, desc: &ResourceDesc, size: &str, why: &str) {
    let _ = writeln!(out, "  {name:<9} {:<46} {why}", format!("{}, {size}", shape(desc)));
}
