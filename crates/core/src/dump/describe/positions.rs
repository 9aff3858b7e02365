//! Position of each pass in the order.

use crate::handle::PassId;
use crate::plan::Plan;

/// Positions of all passes of a plan.
#[derive(Clone, Debug)]
pub struct Positions(Vec<Option<Position>>);

/// Position of a pass in the order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// Index among all passes that run.
    pub order: usize,
    /// Index of its step.
    pub step: usize,
    /// Index among the passes of the step.
    pub within: usize,
    /// Number of passes of the step.
    pub passes: usize,
}

impl Positions {
    /// Finds the positions of all passes.
    pub fn new(plan: &Plan) -> Self {
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

    /// Returns the position of a pass of the plan; `None` if the pass is culled.
    ///
    /// # Panics
    /// If the id is out of range for the plan.
    pub fn get(&self, pass: PassId) -> Option<Position> {
        self.0[pass.index()]
    }
}
