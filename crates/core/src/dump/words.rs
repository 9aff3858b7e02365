//! Decisions as sentences, a file for each kind of decision.
//!
//! The public functions take a reason and know nothing else. The dumps know the subject too, so theirs, which end in
//! `_sentence`, can say more.

mod cull;
mod merge;
mod ops;
mod order;
mod shape;
mod slot;
mod touch;

pub(super) use shape::{bytes, clear, clip, list, quoted, shape, steps, usage};
pub(super) use touch::verb;
