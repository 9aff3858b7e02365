//! Shadows that are collected in a screen mask.

use serde::{Deserialize, Serialize};

use super::check::in_range;
use crate::Error;

/// How a screen mask of collected shadows is blurred.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ScreenSettings {
    /// How far edges are blurred, metres, 0 (not at all) to 10. Nearby that is more pixels.
    pub blur_m: f32,
    /// The most that edges are blurred, pixels, 1 to 32.
    pub blur_max_px: f32,
    /// How far apart in view depth two surfaces are that are not blurred over each other, in parts of the view depth,
    /// 0.0001 to 1.
    pub depth_threshold: f32,
}

impl Default for ScreenSettings {
    fn default() -> Self {
        Self { blur_m: 0.0, blur_max_px: 8.0, depth_threshold: 0.02 }
    }
}

impl ScreenSettings {
    pub(super) fn validate(&self) -> Result<(), Error> {
        in_range("screen.blur_m", self.blur_m, 0.0, 10.0, "0 to 10 (metres)")?;
        in_range("screen.blur_max_px", self.blur_max_px, 1.0, 32.0, "1 to 32 (pixels)")?;
        in_range("screen.depth_threshold", self.depth_threshold, 1e-4, 1.0, "0.0001 to 1 (part of the depth)")
    }
}
