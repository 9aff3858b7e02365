//! What users choose of `screen` and `contact`.

use serde::{Deserialize, Serialize};

use crate::settings::{in_range, setting};
use crate::{Error, TechniqueSettings};

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

impl TechniqueSettings for ScreenSettings {
    const NAME: &'static str = "screen";

    fn validate(&self) -> Result<(), Error> {
        in_range("blur_m", self.blur_m, 0.0, 10.0, "0 to 10 (metres)")?;
        in_range("blur_max_px", self.blur_max_px, 1.0, 32.0, "1 to 32 (pixels)")?;
        in_range("depth_threshold", self.depth_threshold, 1e-4, 1.0, "0.0001 to 1 (part of the depth)")
    }
}

/// How far short shadows are looked for on the screen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ContactSettings {
    /// How far from a surface what casts a shadow on it is looked for, metres, 0.001 to 10.
    pub length_m: f32,
    /// How thick what the picture shows is taken to be, metres, 0.001 to 10: what passes farther behind it is lit.
    pub thickness_m: f32,
    /// How many places are looked at on the way, 1 to 64.
    pub steps: u32,
}

impl Default for ContactSettings {
    fn default() -> Self {
        Self { length_m: 0.2, thickness_m: 0.2, steps: 16 }
    }
}

impl TechniqueSettings for ContactSettings {
    const NAME: &'static str = "contact";

    fn validate(&self) -> Result<(), Error> {
        in_range("length_m", self.length_m, 0.001, 10.0, "0.001 to 10 (metres)")?;
        in_range("thickness_m", self.thickness_m, 0.001, 10.0, "0.001 to 10 (metres)")?;
        match self.steps {
            1..=64 => Ok(()),
            steps => Err(setting("steps", steps, "1 to 64")),
        }
    }
}
