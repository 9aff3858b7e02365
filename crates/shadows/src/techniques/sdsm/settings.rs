//! Settings of `sdsm`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `sdsm`.
    pub struct SdsmSettings {
        /// Ends of the cascades in the visible range: 0 at equal distances, 1 at equal ratios.
        lambda: f32 = 1.0, 0..=1;
        /// Exponent that makes nearer cascades shorter: cascade i of n ends at (i / n)^nearness of the range; 1 for no change. Most pixels show
        /// near surfaces.
        nearness: f32 = 1.4, 0.5..=4;
    }
}

impl NamedSettings for SdsmSettings {
    const NAME: &'static str = "sdsm";
}
