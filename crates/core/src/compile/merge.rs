//! Which passes share one render pass of the encoder.

use crate::handle::PassId;
use crate::plan::Step;

/// Returns the steps: for now each pass is a step of its own.
pub(super) fn merge(order: &[PassId]) -> Vec<Step> {
    order.iter().map(|&pass| Step { passes: vec![pass] }).collect()
}
