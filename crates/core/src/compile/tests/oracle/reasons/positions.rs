//! Reasons of the positions of passes.

use super::super::Oracle;
use super::Facts;
use crate::{MergeReason, OrderPolicy, OrderReason, Origin};

impl Oracle<'_> {
    pub(super) fn place_reasons(&mut self, facts: &Facts<'_>) {
        let order = &facts.live.order;
        for (position, &pass) in order.iter().enumerate() {
            let id = facts.plan.order()[position];
            let Some(reason) = facts.plan.order_reason(id) else {
                return self.truth(false, id, "no order reason");
            };
            let ready: Vec<usize> =
                order[position..].iter().copied().filter(|&p| self.ready(order, position, p)).collect();
            let own = self.freed(order, position, pass);
            let others = || ready.iter().filter(|&&other| other != pass);
            let holds = match reason {
                OrderReason::Fixed => facts.plan.options().order == OrderPolicy::Declared,
                OrderReason::OnlyReady => ready == [pass],
                OrderReason::ContinuesRenderPass => facts.plan.merge_reason(id) == Some(MergeReason::Merged),
                OrderReason::FreesMemory(bytes) => {
                    bytes == own && others().all(|&other| self.freed(order, position, other) < own)
                }
                OrderReason::DeclaredFirst => others().all(|&other| {
                    let freed = self.freed(order, position, other);
                    freed < own || freed == own && other > pass
                }),
                OrderReason::DeclarationNeedsLess => order.is_sorted(),
                OrderReason::BackwardsNeedsLess => {
                    let last = order.len() - 1;
                    !order.is_sorted() && facts.plan.order_reason(facts.plan.order()[last]) == Some(reason)
                }
            };
            self.truth(holds, id, reason);
        }
    }

    /// Returns whether everything that must run before the pass has run.
    fn ready(&self, order: &[usize], position: usize, pass: usize) -> bool {
        order[position..].iter().all(|&other| other >= pass || !self.model.ordered(other, pass))
    }

    /// Bytes that are no longer in use after the pass, less those that it begins to use.
    fn freed(&self, order: &[usize], position: usize, pass: usize) -> i64 {
        let spec = self.model.spec;
        let touches = |pass: usize, resource: usize| self.does(pass, resource, |_| true);
        let change = |resource: usize| {
            let bytes = spec.desc(resource).bytes() as i64;
            let new = !order[..position].iter().any(|&other| touches(other, resource));
            let rest = order[position..].iter().any(|&other| other != pass && touches(other, resource));
            let ends = !rest && !spec.is_exported(resource);
            i64::from(ends) * bytes - i64::from(new) * bytes
        };
        let transient = |r: &usize| spec.resources[*r].origin == Origin::Transient && touches(pass, *r);
        (0..spec.resources.len()).filter(transient).map(change).sum()
    }
}
