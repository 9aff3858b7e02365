//! The plan as aligned text, at most 110 columns wide.

use super::describe::{Position, Positions, bytes, clip, shape, steps, usage};
use crate::declaration::{Options, OrderPolicy, Origin, PassKind};
use crate::desc::ResourceDesc;
use crate::handle::{NodeId, PassId, ResourceId};
use crate::plan::{AccessPlan, LoadAction, MergeReason, Plan, ResourcePlan, SlotReason, StoreAction};
use crate::subresource::Subresource;
use std::fmt::Write as _;

/// Maximum length of a line; longer text is cut with an ellipsis.
const COLUMNS: usize = 110;
/// Width of a resource's name with its version and subresource, in columns.
const NAME: usize = 40;
/// Width of the names in the note after it, in columns.
const NOTE: usize = 36;

impl Plan {
    /// Returns the plan as text: passes by node and in order, with their accesses, loads and stores; culled passes;
    /// and resources by the slot, a physical texture or buffer, that they share. Every decision has its reason. The
    /// same plan gives the same text.
    pub fn to_text(&self) -> String {
        let mut out = String::new();
        self.write_summary(&mut out);
        self.write_passes(&mut out);
        self.write_culled(&mut out);
        self.write_resources(&mut out);
        fit(&out)
    }

    fn write_summary(&self, out: &mut String) {
        let _ = writeln!(out, "plan: {}", self.summary());
        let options = options(self.options());
        if !options.is_empty() {
            let _ = writeln!(out, "options: {}", options.join(", "));
        }
    }

    fn write_culled(&self, out: &mut String) {
        if self.culled_count() == 0 {
            return;
        }
        out.push_str("\nculled\n");
        for (id, pass) in self.passes() {
            if let Some(reason) = pass.culled {
                let path = clip(&self.pass_path(id), 40);
                let _ = writeln!(out, "  {path:<40}  {}", self.describe_cull(reason));
            }
        }
    }
}

/// Names the options that differ from the default.
fn options(options: Options) -> Vec<&'static str> {
    let Options { order, merge, transient_attachments } = options;
    let order = match order {
        OrderPolicy::Automatic => None,
        OrderPolicy::Memory => Some("the order is chosen by memory only, not for merging"),
        OrderPolicy::Declared => Some("the order of declaration is fixed"),
    };
    let merge = (!merge).then_some("merging is off");
    let transient = (!transient_attachments).then_some("transient attachments are off");
    [order, merge, transient].into_iter().flatten().collect()
}

/// Cuts every line to the width and its trailing blanks.
fn fit(text: &str) -> String {
    text.lines().flat_map(|line| [clip(line.trim_end(), COLUMNS), "\n".into()]).collect()
}

impl Plan {
    /// Counts passes, steps, resources and slots, and sums their memory.
    pub fn summary(&self) -> String {
        let assigned = self.slots().map(|slot| slot.resources.len()).sum::<usize>();
        let outside = match self.resources().len() - assigned {
            0 => String::new(),
            others => format!(", {others} external"),
        };
        format!(
            "{} in {}, {} culled; {} in {} of {}{outside}; sharing saves {}",
            count(self.order().len(), "pass", "passes"),
            count(self.steps().len(), "step", "steps"),
            self.culled_count(),
            count(assigned, "resource", "resources"),
            count(self.slots().len(), "slot", "slots"),
            bytes(self.slot_bytes()),
            bytes(self.saved_bytes()),
        )
    }
}

fn count(number: usize, one: &str, many: &str) -> String {
    format!("{number} {}", if number == 1 { one } else { many })
}

impl Plan {
    fn write_passes(&self, out: &mut String) {
        let positions = Positions::new(self);
        let shared = self.steps().any(|step| step.passes.len() > 1);
        out.push_str("\npasses by step");
        out.push_str(if shared { "; `+` continues the render pass above\n" } else { "\n" });
        let mut node: Option<Option<NodeId>> = if self.nodes().len() == 0 { Some(None) } else { None };
        for &id in self.order() {
            let pass = self.pass(id);
            if node != Some(pass.node) {
                out.push_str(if node.is_some() { "\n" } else { "" });
                node = Some(pass.node);
                let _ = writeln!(out, "  {}", pass.node.map_or("(no node)".into(), |n| self.node_path(n)));
            }
            let Some(position) = positions.get(id) else { continue };
            self.write_pass(out, id, position);
        }
    }

    fn write_pass(&self, out: &mut String, id: PassId, position: Position) {
        let pass = self.pass(id);
        let joins = position.within > 0;
        let _ = writeln!(
            out,
            "  {:>4} {} {:<32} {:<8} {}",
            position.step,
            if joins { '+' } else { ' ' },
            clip(pass.name, 32),
            pass.kind.as_str(),
            self.describe_order(self.order_reasons[position.order]),
        );
        let merge = self.merge_reasons[position.order];
        let plain = matches!(merge, MergeReason::First | MergeReason::Kind(_) | MergeReason::Off);
        if pass.kind == PassKind::Render && !plain {
            let what = if joins { "same render pass" } else { "own render pass" };
            let _ = writeln!(out, "         {what}: {}", self.explain_merge(position.order));
        }
        if pass.keep {
            let _ = writeln!(out, "         kept even if nothing needs what it writes");
        }
        for note in self.pass_notes(id) {
            let _ = writeln!(out, "         {note}");
        }
        for access in self.accesses(id) {
            self.write_access(out, id, &access);
        }
    }

    fn write_access(&self, out: &mut String, pass: PassId, access: &AccessPlan) {
        let writes = access.access.writes();
        let (arrow, version) = if writes { ("->", access.version + 1) } else { ("<-", access.version) };
        let mut tail = format!(" v{version}");
        if access.subresource != Subresource::FULL {
            let _ = write!(tail, ", {}", access.subresource);
        }
        let name = self.resource(access.resource).name;
        let name = clip(name, NAME.saturating_sub(tail.chars().count()).max(12)) + &tail;
        let label = access.access.label();
        let _ = writeln!(
            out,
            "         {arrow} {label:<14} {name:<NAME$} {}",
            self.access_note(pass, access, NOTE)
        );
        self.write_ops(out, pass, access);
    }

    /// Attachments that continue within a render pass have no line: the `+` says so.
    fn write_ops(&self, out: &mut String, pass: PassId, access: &AccessPlan) {
        let Some(ops) = &access.ops else { return };
        if ops.load != LoadAction::Continue {
            let (action, reason) = self.explain_load(access, ops);
            let _ = writeln!(out, "              {action}: {reason}");
        }
        if let Some((action, reason)) = self.explain_done_clear(access, ops) {
            let _ = writeln!(out, "              {action}: {reason}");
        }
        if let Some((action, reason)) = self.explain_drawn_clear(access, ops) {
            let _ = writeln!(out, "              {action}: {reason}");
        }
        if ops.store != StoreAction::Continue {
            let (action, reason) = self.explain_store(pass, access, ops);
            let _ = writeln!(out, "              {action}: {reason}");
        }
    }
}

impl Plan {
    fn write_resources(&self, out: &mut String) {
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
            self.placement_notes(id, &resource).join("; "),
        );
        for note in self.resource_notes(id) {
            let _ = writeln!(out, "      {note}");
        }
    }

    fn placement_notes(&self, id: ResourceId, resource: &ResourcePlan<'_>) -> Vec<String> {
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
