//! The atlas.

use super::DepthFormat;
use super::describe::refused;
use super::filter::ShadowFilter;
use crate::declare_settings;
use crate::error::Error;

declare_settings! {
    /// The atlas: one map for spot and point lights and the directional lights that have no cascades.
    #[check(AtlasSettings::check_tiles)]
    pub struct AtlasSettings {
        /// Width of the map.
        map_size_px: u32 = 2048, power_of_two 256..=8192, in "pixels";
        /// Division of the map among the lights.
        tiles: AtlasTiles = AtlasTiles::ByImportance { smallest_px: 64 };
        /// Keeps the map from frame to frame and draws only what changed, as for cascades.
        cache: bool = true;
        /// Format of the map.
        depth: DepthFormat = DepthFormat::Depth32;
        /// Filter of shadow edges.
        filter: ShadowFilter = ShadowFilter::Tent5;
        /// Distance from a spot or point light at which its depth range begins. Nearer casters are drawn at that distance.
        spot_near_m: f32 = 0.05, 0.0001..=100, in "metres";
    }
}

declare_settings! {
    /// Division of the atlas among its lights. A point light needs six tiles, others one.
    #[derive(Copy, Eq, Hash)]
    pub enum AtlasTiles {
        /// Up to 16 tiles of one size: the map has 1, 2, 3 or 4 tiles per side, as many as its lights need.
        Even;
        /// Tiles whose widths are powers of two, proportional to the part of the image that a light can fill and to its `importance`.
        /// A light's tiles keep size and location while its request changes little. If the map is too small, all tiles get smaller; if that
        /// does not suffice, the least important lights get none.
        ByImportance {
            /// Width of the smallest tile.
            smallest_px: u32 = 64, power_of_two 64..=1024, in "pixels", and "at most a quarter of the map";
        };
    }
}

impl AtlasSettings {
    fn check_tiles(&self) -> Result<(), Error> {
        match self.tiles {
            AtlasTiles::ByImportance { smallest_px } if smallest_px > self.map_size_px / 4 => {
                Err(refused(Self::SETTINGS, "tiles.smallest_px", smallest_px))
            }
            _ => Ok(()),
        }
    }
}
