//! Culling of casters.

use crate::declare_settings;

declare_settings! {
    /// Culling of casters. It never changes what is visible.
    #[derive(Eq)]
    pub struct CullSettings {
        /// Culls casters that cannot darken any visible point within the shadow distance. Switch it off if shadows are evaluated at
        /// points outside the view.
        unseen: bool = true;
        /// Culls a caster from a cascade if finer cascades cover all visible points that it can darken.
        covered: bool = true;
    }
}

impl CullSettings {
    /// Culls only casters that are outside a tile.
    pub const NONE: Self = Self { unseen: false, covered: false };
}
