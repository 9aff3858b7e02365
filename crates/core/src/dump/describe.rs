//! Decisions as sentences.
//!
//! The public `describe_*` functions know only a reason. The dumps also know what it is about, so their `explain_*` functions say more.

mod format;
mod memory;
mod passes;

pub(super) use format::{bytes, clear, clip, list, quoted, shape, steps, usage, verb};
