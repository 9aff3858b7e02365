//! Settings of `raytraced`.

use crate::declare_settings;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `raytraced`.
    pub struct RaytracedSettings {
        /// Rays per pixel and light. A single ray goes to the light's centre and gives hard edges.
        rays: u32 = 8, 1..=64;
        /// Angular radius of directional lights; the sun's is 0.00465.
        sun_radius_rad: f32 = 0.00465, 0..=0.2, in "radians";
        /// Radius of spot and point lights.
        light_radius_m: f32 = 0.05, 0..=10, in "metres", alias "lamp_radius_m";
        /// Radius over which soft edges are averaged on the same surface. Averaging removes the noise of edges that are many pixels wide, as
        /// those of large lights, but blurs narrow edges.
        denoise_px: u32 = 0, 0..=4, in "pixels";
    }
}

impl RaytracedSettings {
    /// Returns settings for one ray of each pixel without denoising: the reference for hard edges.
    #[must_use]
    pub fn hard() -> Self {
        Self { rays: 1, ..Self::default() }
    }
}

impl NamedSettings for RaytracedSettings {
    const NAME: &'static str = "raytraced";
}
