//! Settings of `msm`.

use shadowgraph_core::Format;
use shadowgraph_shaders::{MSM, ModuleSource};

use super::{MomentMap, Moments};
use crate::declare_settings;
use crate::error::Error;
use crate::settings::NamedSettings;

declare_settings! {
    /// Settings of the technique `msm`.
    #[check(MsmSettings::check)]
    pub struct MsmSettings {
        /// Light bleeding reduction: visibility up to this value becomes 0, and the rest is rescaled, which darkens edges.
        bleed: f32 = 0.02, 0..=0.95, in "fraction of the light";
        /// Bias of the moments against rounding errors: if it is too small, noise appears; if it is too large, light leaks.
        bias: f32 = 0.00006, 0.00001..=0.1;
        /// Width of a texel of the moment map in texels of the depth map.
        downscale: u32 = 2, power_of_two 1..=4, in "texels";
        /// Radius of the blur, in texels of the moment map.
        blur_texels: u32 = 0, 0..=4, in "texels", and "downscale x (blur_texels + 1.5 x 2^(mips - 1)) up to 24";
        /// Mip levels of the moment map; distant surfaces read the smaller ones.
        mips: u32 = 2, 1..=3;
    }
}

impl MsmSettings {
    fn check(&self) -> Result<(), Error> {
        self.moment_map().check(Self::SETTINGS)
    }
}

impl NamedSettings for MsmSettings {
    const NAME: &'static str = "msm";
}

impl Moments for MsmSettings {
    const LAYOUTS: u32 = 1;

    fn modules(_layout: u32) -> Vec<ModuleSource> {
        vec![MSM]
    }

    fn format(_layout: u32) -> Format {
        Format::Rg32Uint
    }

    fn layout(&self) -> u32 {
        0
    }

    fn moment_map(&self) -> MomentMap {
        MomentMap { downscale: self.downscale, blur_texels: self.blur_texels, mips: self.mips }
    }
}
