//! Settings of `pcss`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `pcss`.
    pub struct PcssSettings {
        /// Half of the angle that a directional light takes up in the sky; the sun's is 0.00465.
        sun_radius_rad: f32 = 0.00465, 0..=0.2, in "radians";
        /// Radius of spot and point lights.
        light_radius_m: f32 = 0.05, 0..=10, in "metres", alias "lamp_radius_m";
        /// Largest radius of the filter. Tiles have a border as wide.
        max_radius_texels: f32 = 16.0, 1..=24, in "texels", alias "most_texels";
        /// Samples of the search for blockers.
        blocker_taps: u32 = 16, 1..=64;
        /// Comparisons of the filter.
        filter_taps: u32 = 24, 1..=64;
    }
}

impl NamedSettings for PcssSettings {
    const NAME: &'static str = "pcss";
}
