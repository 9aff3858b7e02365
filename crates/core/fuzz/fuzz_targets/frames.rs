//! Valid frames, declared with the builder and compiled, in two orders of declaration: the oracle of the crate's tests
//! checks the plans.
#![no_main]
#![allow(dead_code, unused_imports, reason = "the tests use more of what they share")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test")]

#[path = "../../src/compile/tests/frames/mod.rs"]
mod frames;
#[path = "../../src/compile/tests/oracle/mod.rs"]
mod oracle;
#[path = "../../src/compile/tests/frame_check.rs"]
mod frame_check;

use shadowgraph_core::*;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let spec = frames::frame_from_bytes(bytes);
    for spec in [frame_check::shuffled(&spec, &mut frames::Source::new(bytes)), spec] {
        if let Err(breach) = frame_check::check_frame(&spec) {
            panic!("{breach}\nfrom the bytes {bytes:?}");
        }
    }
});
