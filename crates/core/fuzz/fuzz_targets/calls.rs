//! Any call of the builder with any argument: the frame compiles or returns an error, and nothing panics.
#![no_main]
#![allow(dead_code, unused_imports, reason = "the tests use more of what they share")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test")]

#[path = "../../src/compile/tests/frames/mod.rs"]
mod frames;

use shadowgraph_core::*;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(compiled) = frames::random_calls_from_bytes(bytes).compile() else { return };
    // Every decision can be described.
    let plan = compiled.into_plan();
    let _texts = (plan.to_text(), plan.to_dot(), plan.to_json().unwrap());
});
