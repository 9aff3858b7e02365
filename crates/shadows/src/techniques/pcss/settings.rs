//! What users choose of `pcss`.

use serde::{Deserialize, Serialize};

use crate::settings::{in_range, setting};
use crate::{Error, TechniqueSettings};

/// Settings of the technique `pcss`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PcssSettings {
    /// Half of the angle that directional lights take up in the sky, radians, 0 to 0.2. The sun's is 0.00465.
    pub sun_radius_rad: f32,
    /// The radius of spot and point lights, metres, 0 to 10.
    pub lamp_radius_m: f32,
    /// The most that an edge is softened to either side, texels of the map, 1 to 24. Tiles have a border as wide.
    pub most_texels: f32,
    /// How many texels are looked at for what is in the way, 1 to 64.
    pub blocker_taps: u32,
    /// How many comparisons soften an edge, 1 to 64.
    pub filter_taps: u32,
}

impl Default for PcssSettings {
    fn default() -> Self {
        Self {
            sun_radius_rad: 0.00465,
            lamp_radius_m: 0.05,
            most_texels: 16.0,
            blocker_taps: 16,
            filter_taps: 24,
        }
    }
}

impl TechniqueSettings for PcssSettings {
    const NAME: &'static str = "pcss";

    fn validate(&self) -> Result<(), Error> {
        in_range("sun_radius_rad", self.sun_radius_rad, 0.0, 0.2, "0 to 0.2 (radians)")?;
        in_range("lamp_radius_m", self.lamp_radius_m, 0.0, 10.0, "0 to 10 (metres)")?;
        in_range("most_texels", self.most_texels, 1.0, 24.0, "1 to 24 (texels)")?;
        let taps = [("blocker_taps", self.blocker_taps), ("filter_taps", self.filter_taps)];
        taps.into_iter().try_for_each(|(field, taps)| match taps {
            1..=64 => Ok(()),
            _ => Err(setting(field, taps, "1 to 64")),
        })
    }
}
