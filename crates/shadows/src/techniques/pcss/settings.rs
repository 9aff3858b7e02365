//! Settings of `pcss`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `pcss`.
    pub struct PcssSettings {
        /// Angular radius of directional lights; the sun's is 0.00465.
        sun_radius_rad: f32 = 0.00465, 0..=0.2, in "radians";
        /// Radius of spot and point lights.
        light_radius_m: f32 = 0.05, 0..=10, in "metres", alias "lamp_radius_m";
        /// Maximum radius of the filter, and width of the border of tiles.
        max_radius_texels: f32 = 16.0, 1..=24, in "texels", alias "most_texels";
        /// Samples of the blocker search.
        blocker_taps: u32 = 16, 1..=64;
        /// Depth comparisons of the filter.
        filter_taps: u32 = 24, 1..=64;
    }
}

impl NamedSettings for PcssSettings {
    const NAME: &'static str = "pcss";
}
