//! Decisions as sentences, and short forms of values, for tools that show plans.
//!
//! The `describe_*` methods of [`Plan`](crate::Plan) know only a reason. The `explain_*` methods also know what it is about, so they say more.

mod format;
mod memory;
mod passes;
mod positions;

pub use format::{bytes, list, quoted, shape, steps, verb};
pub(super) use format::{clear, clip, usage};
pub use positions::{Position, Positions};
