//! `cargo xtask noise`: spatiotemporal blue noise, by void and cluster (Ulichney, "The void-and-cluster method for dither array
//! generation", 1993) in three dimensions (Wolfe et al., "Spatiotemporal Blue Noise Masks", 2022): pixels repel each other within
//! a frame, and each pixel repels itself in other frames. So every frame is blue, and the values of a pixel soon cover their range
//! evenly. Donnelly et al. ("FAST: Filter-Adapted Spatio-Temporal Sampling", 2024) optimize noise for one given filter instead.

use crate::child;
use std::process::ExitCode;

/// The file that shaders' noise comes from, relative to the repository's root.
const FILE: &str = "crates/lighting/src/blue_noise.bin";

/// The committed noise: 16 KiB, the smallest for which the errors in `docs/quality.md` are met with a margin.
const COMMITTED: Size = Size { side: 32, frames: 16 };
const SEED: u64 = 1;

/// The standard deviation of the repulsion, pixels and frames.
const SIGMA: f64 = 1.9;
/// The repulsion in time, relative to that in space: more converges faster, and is less blue.
const TIME_WEIGHT: f64 = 2.0;

/// The extent of noise. It repeats in all directions.
#[derive(Clone, Copy)]
struct Size {
    /// Width and height, pixels.
    side: usize,
    frames: usize,
}

pub(crate) fn run() -> ExitCode {
    let file = child::root().join(FILE);
    match std::fs::write(&file, generate(COMMITTED, SEED)) {
        Ok(()) => {
            println!("wrote {FILE}: {0}x{0} pixels, {1} frames", COMMITTED.side, COMMITTED.frames);
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("error: {FILE}: cannot be written: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Returns noise, frame by frame and row by row. In each frame all values from 0 to 255 are equally frequent.
fn generate(size: Size, seed: u64) -> Vec<u8> {
    let ranks = ranks(size, seed);
    let area = size.side * size.side;
    let mut values = vec![0; ranks.len()];
    for first in (0..ranks.len()).step_by(area) {
        let mut order: Vec<usize> = (first..first + area).collect();
        order.sort_by_key(|&point| ranks[point]);
        for (position, point) in order.into_iter().enumerate() {
            values[point] = (position * 256 / area) as u8;
        }
    }
    values
}

/// Returns the rank of each point in an order whose beginnings, of any length, are distributed evenly.
fn ranks(size: Size, seed: u64) -> Vec<usize> {
    let mut pattern = Pattern::relaxed(size, seed);
    let count = pattern.chosen.len();
    let start = pattern.clone();
    let mut ranks = vec![0; count];
    let chosen = pattern.chosen.iter().filter(|chosen| **chosen).count();
    for rank in (0..chosen).rev() {
        let point = pattern.tightest_cluster();
        pattern.toggle(point);
        ranks[point] = rank;
    }
    pattern = start;
    for rank in chosen..count {
        let point = pattern.largest_void();
        pattern.toggle(point);
        ranks[point] = rank;
    }
    ranks
}

/// Chosen points, and how close each point is to them. Integers make it independent of the order of additions.
#[derive(Clone)]
struct Pattern {
    size: Size,
    chosen: Vec<bool>,
    closeness: Vec<i64>,
    /// The repulsion of the points at these offsets in x, y and frame.
    kernel: Vec<([usize; 3], i64)>,
}

impl Pattern {
    /// Chooses a tenth of the points at random, and moves the closest ones into voids until nothing improves.
    fn relaxed(size: Size, seed: u64) -> Self {
        let count = size.side * size.side * size.frames;
        let kernel = kernel(size);
        let mut pattern = Self { size, chosen: vec![false; count], closeness: vec![0; count], kernel };
        let mut random = SplitMix(seed);
        for _ in 0..count / 10 {
            let mut free = || random.next() as usize % count;
            let mut point = free();
            while pattern.chosen[point] {
                point = free();
            }
            pattern.toggle(point);
        }
        loop {
            let from = pattern.tightest_cluster();
            pattern.toggle(from);
            let to = pattern.largest_void();
            if pattern.closeness[to] >= pattern.closeness[from] {
                pattern.toggle(from);
                return pattern;
            }
            pattern.toggle(to);
        }
    }

    /// Chooses a point, or no longer.
    fn toggle(&mut self, point: usize) {
        let Size { side, frames } = self.size;
        let [x, y, frame] = [point % side, point / side % side, point / side / side];
        let sign = if self.chosen[point] { -1 } else { 1 };
        self.chosen[point] = !self.chosen[point];
        for &([right, down, later], weight) in &self.kernel {
            let row = (frame + later) % frames * side + (y + down) % side;
            self.closeness[row * side + (x + right) % side] += sign * weight;
        }
    }

    /// Returns the chosen point that is closest to others.
    fn tightest_cluster(&self) -> usize {
        self.best(true, |closeness| -closeness)
    }

    /// Returns the point that is not chosen and farthest from those that are.
    fn largest_void(&self) -> usize {
        self.best(false, |closeness| closeness)
    }

    /// Returns the first point with the smallest cost among those that are chosen, or are not.
    fn best(&self, chosen: bool, cost: fn(i64) -> i64) -> usize {
        let (mut best, mut least) = (0, i64::MAX);
        for (point, (&is_chosen, &closeness)) in self.chosen.iter().zip(&self.closeness).enumerate() {
            if is_chosen == chosen && cost(closeness) < least {
                (best, least) = (point, cost(closeness));
            }
        }
        best
    }
}

/// Returns the repulsion: a Gaussian within the frame, and one over the frames at the same pixel.
fn kernel(Size { side, frames }: Size) -> Vec<([usize; 3], i64)> {
    let gaussian = |offset: usize, period: usize| {
        let distance = offset.min(period - offset) as f64;
        (-distance * distance / (2.0 * SIGMA * SIGMA)).exp()
    };
    let fixed_point = |weight: f64| (weight * f64::from(1 << 24)).round() as i64;
    let within = (0..side).flat_map(|y| (0..side).map(move |x| [x, y, 0]));
    let within = within.map(|at| (at, fixed_point(gaussian(at[0], side) * gaussian(at[1], side))));
    let over = (1..frames).map(|t| ([0, 0, t], fixed_point(TIME_WEIGHT * gaussian(t, frames))));
    within.chain(over).filter(|(_, weight)| *weight > 0).collect()
}

/// Random numbers (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
struct SplitMix(u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn the_committed_file_is_what_the_command_writes() {
        let committed = std::fs::read(child::root().join(FILE)).unwrap();
        assert!(committed == generate(COMMITTED, SEED), "{FILE} differs: run cargo xtask noise");
    }

    #[test]
    fn noise_depends_on_the_seed_alone() {
        let size = Size { side: 16, frames: 4 };
        assert_eq!(generate(size, 5), generate(size, 5));
        assert_ne!(generate(size, 5), generate(size, 6));
    }
}
