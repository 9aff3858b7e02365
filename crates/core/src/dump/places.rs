//! Where each pass stands, looked up by pass.

use crate::handle::PassId;
use crate::plan::Plan;

/// The place of each pass in the order, and its step; `None` for culled passes.
pub(super) struct Places(Vec<Option<Place>>);

#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Among all passes that run.
    pub(super) order: usize,
    pub(super) step: usize,
    /// Among the passes of the step.
    pub(super) within: usize,
    /// How many passes the step has.
    pub(super) passes: usize,
}

impl Places {
    pub(super) fn of(plan: &Plan) -> Self {
        let mut places = vec![None; plan.pass_count()];
        let mut order = 0;
        for (step, passes) in plan.steps().enumerate() {
            for (within, pass) in passes.passes.iter().enumerate() {
                places[pass.index()] = Some(Place { order, step, within, passes: passes.passes.len() });
                order += 1;
            }
        }
        Self(places)
    }

    pub(super) fn get(&self, pass: PassId) -> Option<Place> {
        self.0[pass.index()]
    }
}
