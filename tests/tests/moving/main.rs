//! Shadow maps that keep what did not change: equal to maps that are drawn every frame, at a cost in proportion to what moved.
//! `SHADOWGRAPH_SOAK` is the number of random frames.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, reason = "tests")]

mod boxes;
mod counts;
mod equal;
mod maps;
mod walking;

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

/// Pseudo-random numbers that are the same in every run (xorshift, Marsaglia 2003).
struct Random(u64);

impl Random {
    fn new(seed: u64) -> Self {
        let mut random = Self(0x9e37_79b9_7f4a_7c15 ^ (seed << 32));
        // The first numbers of similar seeds are similar.
        (0..16).for_each(|_| {
            random.below(2);
        });
        random
    }

    fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % end
    }

    /// Returns a number from `from` to `to`.
    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.below(1 << 20) as f64 / f64::from(1 << 20)
    }
}
