//! Settings of the modifiers `screen` and `contact`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Blur of a screen mask.
    pub struct ScreenSettings {
        /// Radius of the blur in the world; 0 for no blur. Near surfaces are blurred over more pixels.
        blur_m: f32 = 0.0, 0..=10, in "metres";
        /// Maximum radius of the blur on screen.
        blur_max_px: f32 = 8.0, 1..=32, in "pixels";
        /// Distance from the plane of a surface above which other points are not blurred into it.
        plane_threshold: f32 = 0.01, 0.0001..=1, in "fraction of the view depth";
    }
}

impl NamedSettings for ScreenSettings {
    const NAME: &'static str = "screen";
}

declare_settings! {
    /// Contact shadows: short shadows found by ray marching on screen.
    pub struct ContactSettings {
        /// Length of the rays, in texels of the shadow map or in pixels, whichever are wider.
        length_texels: f32 = 16.0, 0.1..=256, in "texels";
        /// Assumed thickness of visible surfaces: a ray that passes farther behind a surface is not blocked by it.
        thickness: f32 = 0.1, 0.001..=100, in "lengths of the ray";
        /// Maximum number of samples along each ray; one for each pixel that it passes is enough.
        max_steps: u32 = 32, 1..=256;
    }
}

impl NamedSettings for ContactSettings {
    const NAME: &'static str = "contact";
}
