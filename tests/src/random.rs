//! Pseudo-random numbers.

/// Pseudo-random numbers that are the same in every run (xorshift, Marsaglia 2003).
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// Creates the numbers of a seed.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        let mut random = Self(0x9e37_79b9_7f4a_7c15 ^ (u64::from(seed) << 32));
        // The first numbers of similar seeds are similar.
        (0..16).for_each(|_| {
            random.flip();
        });
        random
    }

    /// Returns a number from 0 to below `end`, which is above 0.
    pub fn below(&mut self, end: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0 % end
    }

    /// Returns true or false.
    pub fn flip(&mut self) -> bool {
        self.below(2) == 1
    }

    /// Returns a number from 0 to below 1.
    pub fn unit(&mut self) -> f64 {
        self.below(1 << 20) as f64 / f64::from(1 << 20)
    }

    /// Returns a number from `from` to below `to`.
    pub fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.unit()
    }
}
