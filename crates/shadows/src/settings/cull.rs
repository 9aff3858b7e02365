//! Culling of casters.

use crate::declare_settings;

declare_settings! {
    /// Culling of casters. It never changes what is visible.
    #[derive(Eq)]
    pub struct CullSettings {
        /// Leaves out casters that cannot darken anything that the camera sees within the shadow distance. Turn it off where
        /// shadows are evaluated at points outside the view.
        unseen: bool = true;
        /// Leaves a caster out of a cascade if finer cascades cover everything visible that it darkens.
        covered: bool = true;
    }
}

impl CullSettings {
    /// Leaves out only casters that are outside a map.
    pub const NONE: Self = Self { unseen: false, covered: false };
}
