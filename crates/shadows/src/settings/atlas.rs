//! The atlas.

use serde::{Deserialize, Serialize};

use super::DepthFormat;
use super::check::{in_range, map_size, setting};
use crate::{Error, ShadowFilter};

/// The atlas: one map for spot and point lights and the directional lights that have no cascades.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AtlasSettings {
    /// Width of the map, pixels, a power of two from 256 to 8192.
    pub map_size_px: u32,
    /// How it is divided among the lights.
    pub tiles: AtlasTiles,
    /// Whether tiles are kept from frame to frame, and drawn again only when their light, their place or their casters
    /// change. Casters that are not seen are then drawn too, as the next frame may see them.
    pub cache: bool,
    /// How finely the map stores depth.
    pub depth: DepthFormat,
    /// How shadows' edges are smoothed.
    pub filter: ShadowFilter,
    /// Where the depth range of a spot or point light begins, metres from the light, 0.0001 to 100. Nearer casters count
    /// as being there.
    pub spot_near_m: f32,
}

/// How the atlas is divided among its lights. A point light needs six tiles, others one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum AtlasTiles {
    /// Up to 16 tiles of one size: the map is split 1, 2, 3 or 4 times each way, as they need.
    Even,
    /// The larger the part of the picture that a light can fill, times its
    /// [importance](super::LightShadows::importance), the larger its tiles: powers of two. A light keeps size and place
    /// while its wish changes little. If there is too little room, all get smaller, and last the least important get none.
    ByImportance {
        /// The width of the smallest tile, pixels, a power of two from 64 to 1024. At most a quarter of the map.
        smallest_px: u32,
    },
}

impl Default for AtlasSettings {
    fn default() -> Self {
        Self {
            map_size_px: 2048,
            tiles: AtlasTiles::ByImportance { smallest_px: 64 },
            cache: false,
            depth: DepthFormat::default(),
            filter: ShadowFilter::default(),
            spot_near_m: 0.05,
        }
    }
}

impl AtlasSettings {
    pub(super) fn validate(&self) -> Result<(), Error> {
        map_size("atlas.map_size_px", self.map_size_px)?;
        if let AtlasTiles::ByImportance { smallest_px } = self.tiles
            && !(smallest_px.is_power_of_two()
                && (64..=1024).contains(&smallest_px)
                && smallest_px <= self.map_size_px / 4)
        {
            let allowed = "64, 128, 256, 512 or 1024 (pixels), at most a quarter of the map";
            return Err(setting("atlas.tiles.smallest_px", smallest_px, allowed));
        }
        in_range("atlas.spot_near_m", self.spot_near_m, 1e-4, 100.0, "0.0001 to 100 (metres)")
    }
}
