//! The plan as JSON, with its reasons in words beside the data.

use crate::plan::Plan;
use serde::Serialize;

/// Counts up when a field changes its meaning or goes; added fields do not count.
const SCHEMA: u32 = 1;

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

/// One decision as a sentence.
#[derive(Serialize)]
struct Reason {
    pass: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    resource: Option<String>,
    decision: String,
    because: String,
}

impl Plan {
    /// Returns the plan as indented JSON. Same plan, same bytes; `schema` counts incompatible changes.
    ///
    /// # Errors
    /// None that a plan can cause; serde_json's, should it have one.
    pub fn to_json(&self) -> Result<String, serde_json::Error> {
        let document = Document {
            schema: SCHEMA,
            summary: Summary {
                passes: self.passes.len(),
                culled: self.passes.iter().filter(|p| p.culled.is_some()).count(),
                steps: self.order.len(),
                resources: self.resources.len(),
                slots: self.slots.len(),
                slot_bytes: self.slot_bytes(),
                saved_bytes: self.saved_bytes(),
            },
            plan: self,
            reasons: self.reasons(),
        };
        serde_json::to_string_pretty(&document)
    }

    fn reasons(&self) -> Vec<Reason> {
        let mut reasons = Vec::new();
        for (index, pass) in self.passes.iter().enumerate() {
            let path = self.pass_path(crate::PassId(index as u32));
            if let Some(culled) = pass.culled {
                let because = self.cull_words(culled);
                reasons.push(Reason {
                    pass: path.clone(),
                    resource: None,
                    decision: "culled".into(),
                    because,
                });
            }
            for access in &pass.accesses {
                let Some(ops) = &access.ops else { continue };
                let resource = Some(self.resource(access.resource).name.clone());
                let (decision, because) = self.load_words(ops);
                reasons.push(Reason { pass: path.clone(), resource: resource.clone(), decision, because });
                let (decision, because) = self.store_words(ops);
                reasons.push(Reason { pass: path.clone(), resource, decision: decision.into(), because });
            }
        }
        reasons
    }
}
