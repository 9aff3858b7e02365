//! Passes that run, by node and in order.

use crate::declaration::PassKind;
use crate::dump::describe::clip;
use crate::dump::describe::{Position, Positions};
use crate::handle::{NodeId, PassId};
use crate::plan::{AccessPlan, LoadAction, MergeReason, Plan, StoreAction};
use std::fmt::Write as _;

/// Width of a resource's name with its version and subresource, in columns.
const NAME: usize = 40;
/// Width of the names in the note after it, in columns.
const NOTE: usize = 36;

impl Plan {
    pub(super) fn write_passes(&self, out: &mut String) {
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
        for access in self.accesses(id) {
            self.write_access(out, id, &access);
        }
    }

    fn write_access(&self, out: &mut String, pass: PassId, access: &AccessPlan) {
        let writes = access.access.writes();
        let (arrow, version) = if writes { ("->", access.version + 1) } else { ("<-", access.version) };
        let mut tail = format!(" v{version}");
        if access.subresource != crate::Subresource::FULL {
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
