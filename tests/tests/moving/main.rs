//! Shadow maps that keep what did not change: equal to maps that are drawn every frame, at a cost in proportion to what moved.
//! `SHADOWGRAPH_SOAK` is the number of random frames.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod boxes;
mod counts;
mod equal;
mod images;
mod maps;
mod scene_counts;
mod walking;
mod worlds;

use shadowgraph::Gpu;
use shadowgraph::options::AdapterChoice;
use std::sync::OnceLock;

/// Returns the device of the tests, or `None` after reporting a skip.
fn gpu() -> Option<&'static Gpu> {
    static GPU: OnceLock<Result<Gpu, String>> = OnceLock::new();
    match GPU.get_or_init(|| Gpu::open(&AdapterChoice::Auto).map_err(|error| error.to_string())) {
        Ok(gpu) => Some(gpu),
        Err(reason) => {
            shadowgraph_tests::skip("pixels", reason);
            None
        }
    }
}

/// Returns the number of frames to draw.
fn frames() -> u64 {
    std::env::var("SHADOWGRAPH_SOAK").ok().and_then(|frames| frames.parse().ok()).unwrap_or(120)
}
