//! Sizes as levels: level 0 is the smallest size, a cell, and each further one is twice as wide.

use std::f64::consts::SQRT_2;

use super::rules::AllotRules;

/// The levels that some rules allow.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levels {
    rules: AllotRules,
}

impl Levels {
    /// Returns `None` if the map has no pixels.
    pub(super) fn new(rules: &AllotRules) -> Option<Self> {
        Some(Self { rules: rules.sound()? })
    }

    /// The rules, made sound.
    pub(super) fn rules(&self) -> AllotRules {
        self.rules
    }

    /// The level of the map, 31 at most.
    pub(super) fn map(&self) -> u32 {
        self.level(self.rules.map_px)
    }

    /// The level of a width in pixels, which is rounded down and kept between the smallest and the map's.
    pub(super) fn level(&self, px: u32) -> u32 {
        let cells = px.min(self.rules.map_px) / self.rules.smallest_px;
        cells.checked_ilog2().unwrap_or(0)
    }

    /// The width of a level, pixels.
    pub(super) fn px(&self, level: u32) -> u32 {
        self.rules.smallest_px << level
    }

    /// The area of a tile of a level, cells.
    pub(super) fn cells(&self, level: u32) -> u64 {
        1 << (2 * level)
    }

    /// A wished width within what is allowed, pixels; the smallest for what is not finite.
    pub(super) fn clamp(&self, px: f64) -> f64 {
        let (smallest, largest) = (f64::from(self.rules.smallest_px), f64::from(self.rules.largest_px));
        if px.is_finite() { px.clamp(smallest, largest) } else { smallest }
    }

    /// The level whose width is nearest to one from [`clamp`](Self::clamp), as a ratio.
    pub(super) fn nearest(&self, px: f64) -> u32 {
        // Without a logarithm, whose last digit differs between machines.
        let below = self.level(px as u32);
        below + u32::from(px > f64::from(self.px(below)) * SQRT_2)
    }
}
