//! Random numbers.

use crate::demo::noise::cell;

/// A stream of random numbers.
pub(super) struct Random {
    seed: u64,
    stream: u32,
    count: i64,
}

impl Random {
    /// Creates one of the streams of a seed.
    pub(super) fn new(seed: u64, stream: u32) -> Self {
        Self { seed, stream, count: 0 }
    }

    /// Returns a number from `low` up to `high`.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.count += 1;
        low + (high - low) * cell(self.stream.into(), self.count, self.seed)
    }

    /// Returns one of the items.
    pub(super) fn pick<T: Copy, const N: usize>(&mut self, items: &[T; N]) -> T {
        items[self.between(0.0, N as f64) as usize]
    }

    /// Returns whether something of this probability, 0 to 1, happens.
    pub(super) fn happens(&mut self, probability: f64) -> bool {
        self.between(0.0, 1.0) < probability
    }
}
