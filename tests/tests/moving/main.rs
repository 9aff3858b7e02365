//! Shadow maps that keep what did not change: equal to maps that are drawn every frame, at a cost in proportion to what moved.
//! `SHADOWGRAPH_SOAK` is the number of random frames, and
//! `SHADOWGRAPH_SOAK_SEED` the seed of images.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod boxes;
mod counts;
mod culling;
mod equal;
mod images;
mod maps;
mod pages;
mod recordings;
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
    from_env("SHADOWGRAPH_SOAK").unwrap_or(60)
}

/// Returns the seed of the first random numbers.
fn seed() -> u32 {
    100 * from_env("SHADOWGRAPH_SOAK_SEED").unwrap_or(0) as u32
}

fn from_env(name: &str) -> Option<u64> {
    std::env::var(name).ok().and_then(|value| value.parse().ok())
}
