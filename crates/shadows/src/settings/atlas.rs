//! The atlas.

use serde::{Deserialize, Serialize};

use super::DepthFormat;
use super::check::{in_range, map_size};
use crate::{Error, ShadowFilter};

/// The atlas: one map for spot lights and the directional lights that have no cascades, up to 16 of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AtlasSettings {
    /// Width of the map, pixels, a power of two from 256 to 8192. It is split 1, 2, 3 or 4 times each way.
    pub map_size_px: u32,
    /// How finely the map stores depth.
    pub depth: DepthFormat,
    /// How shadows' edges are smoothed.
    pub filter: ShadowFilter,
    /// Where the depth range of a spot light begins, metres from the light, 0.0001 to 100. Nearer casters count
    /// as being there.
    pub spot_near_m: f32,
}

impl Default for AtlasSettings {
    fn default() -> Self {
        Self {
            map_size_px: 2048,
            depth: DepthFormat::default(),
            filter: ShadowFilter::default(),
            spot_near_m: 0.05,
        }
    }
}

impl AtlasSettings {
    pub(super) fn validate(&self) -> Result<(), Error> {
        map_size("atlas.map_size_px", self.map_size_px)?;
        in_range("atlas.spot_near_m", self.spot_near_m, 1e-4, 100.0, "0.0001 to 100 (metres)")
    }
}
