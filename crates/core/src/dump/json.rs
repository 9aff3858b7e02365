//! The plan as JSON, with its reasons as sentences next to the data.

use super::describe::{Position, Positions};
use crate::declaration::Origin;
use crate::handle::{PassId, ResourceId};
use crate::plan::{AccessPlan, Plan};
use crate::subresource::Subresource;
use serde::Serialize;

/// Schema version of [`Plan::to_json`]. It increases when a field changes its meaning or is removed, not when one is added.
pub const JSON_SCHEMA: u32 = 3;

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    summary: Summary,
    plan: &'a Plan,
    reasons: Vec<Reason>,
}

#[derive(Serialize)]
struct Summary {
    passes: usize,
    culled: usize,
    steps: usize,
    resources: usize,
    slots: usize,
    slot_bytes: u64,
    saved_bytes: u64,
}

impl Plan {
    /// Returns the plan as indented JSON. The same plan gives the same bytes; `schema` increases with incompatible changes.
    ///
    /// Next to the plan's own data, `reasons` has each decision as a sentence: `decision` is one of `culled`,
    /// `order_reasons`, `merged`, `load`, `clear drawn`, `store` and `slot`, `action` is the decision and `because` the reason.
    ///
    /// # Errors
    /// Those of serde_json; a plan causes none.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        serde_json::to_string_pretty(&self.document())
    }

    fn document(&self) -> Document<'_> {
        Document {
            schema: JSON_SCHEMA,
            summary: Summary {
                passes: self.pass_count(),
                culled: self.culled_count(),
                steps: self.steps().len(),
                resources: self.resources().len(),
                slots: self.slots().len(),
                slot_bytes: self.slot_bytes(),
                saved_bytes: self.saved_bytes(),
            },
            plan: self,
            reasons: self.reasons(),
        }
    }
}

#[derive(Serialize)]
struct Reason {
    #[serde(skip_serializing_if = "Option::is_none")]
    pass: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    resource: Option<String>,
    #[serde(rename = "part", skip_serializing_if = "Option::is_none")]
    subresource: Option<String>,
    /// Name of the decision.
    decision: &'static str,
    /// The decision itself.
    action: String,
    because: String,
}

impl Plan {
    /// Returns the reasons of passes in order of declaration, then those of resources.
    fn reasons(&self) -> Vec<Reason> {
        let positions = Positions::new(self);
        let mut reasons = Vec::new();
        for (id, pass) in self.passes() {
            if let Some(culled) = pass.culled {
                let because = self.describe_cull(culled);
                reasons.push(self.of_pass(id, "culled", "does not run".into(), because));
            }
            if let Some(position) = positions.get(id) {
                self.push_order(&mut reasons, id, position);
            }
            for access in self.accesses(id) {
                self.push_ops(&mut reasons, id, &access);
            }
        }
        reasons.extend(self.resources().map(|(id, _)| self.slot_reason(id)));
        reasons
    }

    fn of_pass(&self, pass: PassId, decision: &'static str, action: String, because: String) -> Reason {
        Reason {
            pass: Some(self.pass_path(pass)),
            resource: None,
            subresource: None,
            decision,
            action,
            because,
        }
    }

    fn push_order(&self, reasons: &mut Vec<Reason>, id: PassId, position: Position) {
        let because = self.describe_order(self.order_reasons[position.order]);
        reasons.push(self.of_pass(id, "placed", format!("step {}", position.step), because));
        let action = if position.within > 0 { "same render pass" } else { "not merged" };
        reasons.push(self.of_pass(id, "merged", action.into(), self.explain_merge(position.order)));
    }

    fn push_ops(&self, reasons: &mut Vec<Reason>, pass: PassId, access: &AccessPlan) {
        let Some(ops) = &access.ops else { return };
        let of_access = |decision, (action, because)| Reason {
            pass: Some(self.pass_path(pass)),
            resource: Some(self.resource_path(access.resource)),
            subresource: (access.subresource != Subresource::FULL).then(|| access.subresource.to_string()),
            decision,
            action,
            because,
        };
        reasons.push(of_access("load", self.explain_load(access, ops)));
        reasons.extend(self.explain_drawn_clear(access, ops).map(|clear| of_access("clear drawn", clear)));
        let (action, because) = self.explain_store(pass, access, ops);
        reasons.push(of_access("store", (action.to_owned(), because)));
    }

    fn slot_reason(&self, id: ResourceId) -> Reason {
        let resource = self.resource(id);
        let action = match (resource.origin, resource.slot) {
            (Origin::Imported { .. }, _) => "import".into(),
            (Origin::Previous { history } | Origin::Current { history }, _) => format!("history {history}"),
            (Origin::Transient, Some(slot)) => format!("slot {}", slot.index()),
            (Origin::Transient, None) => "no slot".into(),
        };
        Reason {
            pass: None,
            resource: Some(self.resource_path(id)),
            subresource: None,
            decision: "slot",
            action,
            because: self.explain_slot(id),
        }
    }
}
