//! Controllers that measure made-up scenes.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

mod back_off;
mod changes;
mod convergence;
mod lowering;
mod recovery;
mod rules;
mod smoothing;
mod splits;

use proptest::prelude::*;

use super::*;
use crate::{AtlasTiles, Error, ShadowSettings, SplitScheme};

const BUDGET_MS: f64 = 2.0;

/// What the documentation says, not what the code has.
const WINDOW: usize = 9;
const LATENCY: usize = 3;
const FIRST_WAIT: usize = 8 * WINDOW;
const LONGEST_WAIT: usize = 256 * WINDOW;

/// As many levels, that differ in distance.
fn controller(levels: usize) -> QualityController {
    let level = |i: usize| Quality { distance_scale: 1.0 - i as f32 / 40.0, ..Quality::default() };
    let levels = (0..levels).map(level).collect();
    QualityController::new(BudgetRules { budget_ms: BUDGET_MS, levels }).unwrap()
}

/// A scene whose levels cost the same for ever, apart from noise.
#[derive(Clone, Debug)]
struct Scene {
    /// Of each level.
    costs_ms: Vec<f64>,
    /// Up to this part, more or less.
    noise: f64,
    /// At least one of so many frames is not slow; 0: none is slow.
    slow_every: usize,
    random: u64,
    frame: usize,
}

impl Scene {
    fn calm(costs_ms: &[f64]) -> Self {
        Self { costs_ms: costs_ms.to_vec(), noise: 0.0, slow_every: 0, random: 0, frame: 0 }
    }

    /// 0 up to 1, the same in every run.
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

    /// The levels after each of so many frames.
    fn play(&mut self, controller: &mut QualityController, frames: usize) -> Vec<usize> {
        let step = |_| {
            let before = controller.level();
            let changed = controller.update(self.measure(before));
            assert_eq!(changed, controller.level() != before, "the answer is whether the level changed");
            controller.level()
        };
        (0..frames).map(step).collect()
    }
}

/// How often the level goes up or down.
fn changes(levels: &[usize]) -> usize {
    levels.windows(2).filter(|pair| pair[0] != pair[1]).count()
}
