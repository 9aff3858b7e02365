//! The plan as a tree of named fields, for JSON.

use super::{AccessPlan, MergeReason, OrderReason, PassPlan, Plan};
use crate::declaration::NoteSubject;
use serde::ser::{Serialize, SerializeStruct, Serializer};

#[derive(serde::Serialize)]
struct PassDocument<'p> {
    #[serde(flatten)]
    pass: PassPlan<'p>,
    accesses: Vec<AccessPlan>,
    #[serde(rename = "placed")]
    order: Option<OrderReason>,
    merge: Option<MergeReason>,
}

#[derive(serde::Serialize)]
struct NoteDocument<'p> {
    #[serde(flatten)]
    subject: NoteSubject,
    text: &'p str,
}

impl Serialize for Plan {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut position = vec![None; self.pass_count()];
        for (index, pass) in self.order.iter().enumerate() {
            position[pass.index()] = Some(index);
        }
        let passes: Vec<_> = self
            .passes()
            .map(|(id, pass)| PassDocument {
                pass,
                accesses: self.accesses(id).collect(),
                order: position[id.index()].map(|position| self.order_reasons[position]),
                merge: position[id.index()].map(|position| self.merge_reasons[position]),
            })
            .collect();
        let notes = self.decl.notes.iter();
        let notes: Vec<_> = notes
            .map(|note| NoteDocument { subject: note.subject, text: self.decl.names.get(note.text) })
            .collect();
        let mut plan = serializer.serialize_struct("Plan", 7 + usize::from(!notes.is_empty()))?;
        plan.serialize_field("options", &self.options())?;
        plan.serialize_field("nodes", &self.nodes().collect::<Vec<_>>())?;
        plan.serialize_field("passes", &passes)?;
        plan.serialize_field("resources", &self.resources().map(|(_, r)| r).collect::<Vec<_>>())?;
        plan.serialize_field("slots", &self.slots().collect::<Vec<_>>())?;
        plan.serialize_field("order", &self.steps().collect::<Vec<_>>())?;
        plan.serialize_field("dependencies", &self.dependencies)?;
        if !notes.is_empty() {
            plan.serialize_field("notes", &notes)?;
        }
        plan.end()
    }
}
