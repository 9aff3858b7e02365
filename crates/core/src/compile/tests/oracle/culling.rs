//! A pass runs if and only if something needs what it writes.

use super::truth::{Stamp, Truth};
use super::{Oracle, Rule, spec_pass};
use crate::Plan;

impl Oracle<'_> {
    /// Follows the contents back from resources that outlive the frame and from kept passes, cell by cell.
    pub(super) fn culling(&mut self, truth: &Truth, plan: &Plan) {
        let spec = self.model.spec;
        let mut needed = vec![false; spec.passes.len()];
        let mut open: Vec<usize> = (0..spec.passes.len()).filter(|&pass| spec.passes[pass].keep).collect();
        for resource in (0..spec.resources.len()).filter(|&resource| spec.outlives(resource)) {
            open.extend(truth.finals[resource].iter().filter_map(writer));
        }
        while let Some(pass) = open.pop() {
            if !std::mem::replace(&mut needed[pass], true) {
                open.extend(truth.needs[pass].iter().flatten().filter_map(|(_, stamp)| writer(stamp)));
            }
        }
        for (id, pass) in plan.passes() {
            let runs = pass.culled.is_none();
            let needed = needed[spec_pass(id)];
            self.expect(runs == needed, Rule::Culling, || {
                format!(
                    "{} is {}needed and {}",
                    pass.name,
                    if needed { "" } else { "not " },
                    if runs { "runs" } else { "culled" }
                )
            });
        }
    }

    /// Returns whether the order lists every pass that is not culled once, and the steps are the order in runs.
    pub(super) fn permutation(&mut self, plan: &Plan) -> bool {
        let mut expected: Vec<_> =
            plan.passes().filter(|(_, pass)| pass.culled.is_none()).map(|(id, _)| id).collect();
        let mut order = plan.order().to_vec();
        let steps: Vec<_> = plan.steps().flat_map(|step| step.passes.to_vec()).collect();
        let runs = steps == order && plan.steps().all(|step| !step.passes.is_empty());
        expected.sort();
        order.sort();
        self.expect(order == expected, Rule::Permutation, || format!("{order:?} instead of {expected:?}"));
        self.expect(runs, Rule::Permutation, || format!("the steps are {steps:?}"));
        order == expected && runs
    }
}

fn writer(stamp: &Stamp) -> Option<usize> {
    match stamp {
        Stamp::Written(pass, _) => Some(*pass),
        Stamp::Undefined | Stamp::Initial => None,
    }
}
