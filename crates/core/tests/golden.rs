//! Small frames, each showing one feature, and their dumps. Frames with explanations are in the tests of
//! `shadowgraph-inspect`.
//!
//! The texts are in `golden/NAME.txt`. A different text fails the test and prints the difference; after
//! reading it, accept it with
//! `UPDATE_GOLDEN=1 cargo test -p shadowgraph-core --no-default-features --test golden`.

#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

#[path = "golden/compare.rs"]
mod compare;
#[path = "golden/contents.rs"]
mod contents;
#[path = "golden/formats.rs"]
mod formats;
#[path = "golden/frame.rs"]
mod frame;
#[path = "golden/helpers.rs"]
mod helpers;
#[path = "golden/memory.rs"]
mod memory;
#[path = "golden/merging.rs"]
mod merging;
#[path = "golden/order.rs"]
mod order;
#[path = "golden/regions.rs"]
mod regions;

use compare::check;
use helpers::{BLACK, FAR, depth, draw, filter, hdr, plan};
