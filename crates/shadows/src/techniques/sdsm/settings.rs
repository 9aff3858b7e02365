//! Settings of `sdsm`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `sdsm`.
    pub struct SdsmSettings {
        /// Split of the visible depth range: 0 for cascades of equal length, 1 for ends at equal ratios.
        lambda: f32 = 1.0, 0..=1;
        /// Exponent that makes near cascades shorter if it is above 1, because most pixels show near surfaces: cascade i of n ends at the
        /// fraction (i / n)^nearness of the range.
        nearness: f32 = 1.4, 0.5..=4;
    }
}

impl NamedSettings for SdsmSettings {
    const NAME: &'static str = "sdsm";
}
