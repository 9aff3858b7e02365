//! What users choose of `raytraced`.

use serde::{Deserialize, Serialize};

use crate::settings::{in_range, setting};
use crate::{Error, TechniqueSettings};

/// Settings of the technique `raytraced`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RaytracedSettings {
    /// How many rays look for each light from each pixel, 1 to 64. One ray sees the light's middle: edges are hard.
    pub rays: u32,
    /// Half of the angle that directional lights take up in the sky, radians, 0 to 0.2. The sun's is 0.00465.
    pub sun_radius_rad: f32,
    /// The radius of spot and point lights, metres, 0 to 10.
    pub lamp_radius_m: f32,
    /// How many pixels soft edges are averaged over to either side, on the same surface, 0 to 4. It takes the grain out of edges that
    /// are many pixels wide, as of large lights; of narrow ones it takes the shape.
    pub denoise_px: u32,
}

impl Default for RaytracedSettings {
    fn default() -> Self {
        Self { rays: 8, sun_radius_rad: 0.00465, lamp_radius_m: 0.05, denoise_px: 0 }
    }
}

impl RaytracedSettings {
    /// One ray a pixel, and nothing averaged: what other techniques' hard edges are compared with.
    #[must_use]
    pub fn hard() -> Self {
        Self { rays: 1, ..Self::default() }
    }
}

impl TechniqueSettings for RaytracedSettings {
    const NAME: &'static str = "raytraced";

    fn validate(&self) -> Result<(), Error> {
        in_range("sun_radius_rad", self.sun_radius_rad, 0.0, 0.2, "0 to 0.2 (radians)")?;
        in_range("lamp_radius_m", self.lamp_radius_m, 0.0, 10.0, "0 to 10 (metres)")?;
        if !(1..=64).contains(&self.rays) {
            return Err(setting("rays", self.rays, "1 to 64"));
        }
        if self.denoise_px > 4 {
            return Err(setting("denoise_px", self.denoise_px, "0 to 4 (pixels)"));
        }
        Ok(())
    }
}
