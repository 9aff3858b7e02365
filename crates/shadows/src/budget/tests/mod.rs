//! Controllers with simulated scenes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod changes;
mod config;
mod convergence;
mod lowering;
mod recovery;
mod retries;
mod smoothing;
mod splits;

use proptest::prelude::*;

use super::*;
use crate::error::Error;
use crate::settings::{AtlasTiles, ShadowSettings, SplitScheme};

const BUDGET_MS: f64 = 2.0;

/// The numbers of the documentation, not the constants of the code.
const WINDOW: usize = 9;
const LATENCY: usize = 3;
const FIRST_WAIT: usize = 8 * WINDOW;
const LONGEST_WAIT: usize = 256 * WINDOW;

/// Returns a controller with this many levels, which differ in distance.
fn controller(levels: usize) -> QualityController {
    let level = |i: usize| QualityLevel { distance_scale: 1.0 - i as f32 / 40.0, ..QualityLevel::default() };
    let levels = (0..levels).map(level).collect();
    QualityController::new(BudgetConfig { budget_ms: BUDGET_MS, levels }).unwrap()
}

/// A scene whose levels have constant costs, apart from noise.
#[derive(Clone, Debug)]
struct Scene {
    /// Cost of each level.
    costs_ms: Vec<f64>,
    /// Largest relative deviation of a frame's time.
    noise: f64,
    /// Every frame with a number divisible by this is slow; 0: none is slow.
    slow_every: usize,
    random: u64,
    frame: usize,
}

impl Scene {
    fn steady(costs_ms: &[f64]) -> Self {
        Self { costs_ms: costs_ms.to_vec(), noise: 0.0, slow_every: 0, random: 0, frame: 0 }
    }

    /// Returns a number from 0 up to 1, the same in every run.
    fn random(&mut self) -> f64 {
        self.random = self.random.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.random;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    fn measure(&mut self, level: usize) -> f64 {
        self.frame += 1;
        let noise = 1.0 + self.noise * (2.0 * self.random() - 1.0);
        let slow = self.slow_every > 0 && self.frame.is_multiple_of(self.slow_every);
        let spike = if slow { 1.0 + 100.0 * self.random() } else { 1.0 };
        self.costs_ms[level] * noise * spike
    }

    /// Runs some frames, and returns the level after each.
    fn play(&mut self, controller: &mut QualityController, frames: usize) -> Vec<usize> {
        let step = |_| {
            let before = controller.level();
            let changed = controller.update(self.measure(before));
            assert_eq!(changed, controller.level() != before, "`update` returns whether the level changed");
            controller.level()
        };
        (0..frames).map(step).collect()
    }
}

/// Returns how many times the level changes.
fn changes(levels: &[usize]) -> usize {
    levels.windows(2).filter(|pair| pair[0] != pair[1]).count()
}
