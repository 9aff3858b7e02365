//! Position of each pass in the order.

use crate::handle::PassId;
use crate::plan::Plan;

/// Positions of all passes; `None` for culled passes.
pub(super) struct Positions(Vec<Option<Position>>);

#[derive(Clone, Copy)]
pub(super) struct Position {
    /// Index among all passes that run.
    pub(super) order: usize,
    pub(super) step: usize,
    /// Index among the passes of the step.
    pub(super) within: usize,
    /// Number of passes of the step.
    pub(super) passes: usize,
}

impl Positions {
    pub(super) fn new(plan: &Plan) -> Self {
        let mut positions = vec![None; plan.pass_count()];
        let mut order = 0;
        for (step, passes) in plan.steps().enumerate() {
            for (within, pass) in passes.passes.iter().enumerate() {
                positions[pass.index()] = Some(Position { order, step, within, passes: passes.passes.len() });
                order += 1;
            }
        }
        Self(positions)
    }

    pub(super) fn get(&self, pass: PassId) -> Option<Position> {
        self.0[pass.index()]
    }
}
