//! Reasons why passes share a render pass or do not.

use super::super::super::frames::AccessSpec;
use super::super::{Oracle, spec_pass};
use super::Facts;
use crate::{Access, Contents, MergeReason, PassId, PassKind};

impl Oracle<'_> {
    pub(super) fn merge_reasons(&mut self, facts: &Facts<'_>, position: usize) {
        let id = facts.plan.order()[position];
        let Some(reason) = facts.plan.merge_reason(id) else {
            return self.truth(false, id, "no merge reason");
        };
        let step = facts.live.steps[position];
        let merged = position > 0 && facts.live.steps[position - 1] == step;
        self.truth(merged == (reason == MergeReason::Merged), id, reason);
        self.truth((position == 0) == (reason == MergeReason::First), id, reason);
        if position > 0 && !merged {
            let before = (0..position).filter(|&other| facts.live.steps[other] + 1 == step);
            let before: Vec<usize> = before.map(|other| facts.live.order[other]).collect();
            let holds = self.is_apart(facts, &before, facts.live.order[position], reason);
            self.truth(holds, id, reason);
        }
    }

    /// Returns whether this is a reason to keep a pass out of the step before it.
    fn is_apart(&self, facts: &Facts<'_>, before: &[usize], own: usize, reason: MergeReason) -> bool {
        let kind = |pass: usize| self.model.spec.passes[pass].kind;
        let (first, last) = (before[0], before[before.len() - 1]);
        let among = |other: PassId| before.contains(&spec_pass(other));
        match reason {
            MergeReason::First | MergeReason::Merged => true,
            MergeReason::Off => !facts.plan.options().merge,
            MergeReason::Kind(other) => kind(own) == other && other != PassKind::Render,
            MergeReason::KindBefore(other) => kind(first) == other && other != PassKind::Render,
            MergeReason::Attachments => {
                [first, own].map(kind) == [PassKind::Render; 2] && !self.same_attachments(first, own)
            }
            MergeReason::Reads(resource, other) => {
                let resource = facts.resource(resource);
                let written = self.does(spec_pass(other), resource, AccessSpec::writes);
                among(other) && written && self.does(own, resource, |access| !access.writes())
            }
            MergeReason::Writes(resource, other) => {
                let resource = facts.resource(resource);
                let touched = self.does(spec_pass(other), resource, |_| true);
                among(other) && touched && self.does(own, resource, AccessSpec::writes)
            }
            MergeReason::Clears(resource) => {
                self.does(own, facts.resource(resource), |access| self.clears_all(access))
            }
            MergeReason::Resolves(resource) => {
                let resolves = |access: &AccessSpec| matches!(access.access, Access::Resolve(_));
                self.does(last, facts.resource(resource), resolves)
            }
        }
    }

    fn clears_all(&self, access: &AccessSpec) -> bool {
        let subresource = access.subresource.cells(&self.model.cells[access.resource]);
        matches!(access.contents, Some(Contents::Clear(_))) && subresource == self.model.attachment(access)
    }
}
