//! The plan as JSON, with its reasons as sentences next to the data.

mod reasons;

use crate::plan::Plan;
use reasons::Reason;
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
