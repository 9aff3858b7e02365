//! Settings of `evsm`, and the encodings of its moments.

use shadowgraph_core::Format;
use shadowgraph_shaders::{EVSM, ModuleSource};

use super::{MomentMap, Moments};
use crate::declare_settings;
use crate::error::Error;
use crate::settings::{NamedSettings, refused};

declare_settings! {
    /// Settings of the technique `evsm`.
    #[check(EvsmSettings::check)]
    pub struct EvsmSettings {
        /// Number of moments that are stored.
        moments: EvsmMoments = EvsmMoments::Four;
        /// Bits of each moment.
        precision: EvsmPrecision = EvsmPrecision::Full;
        /// Exponent of the positive warp: the larger it is, the less light leaks where casters overlap.
        positive_exponent: f32 = 40.0, 1..=42, and "with Half up to 5.54", alias "away";
        /// Exponent of the negative warp, which reduces light leaking near casters.
        negative_exponent: f32 = 5.0, 1..=42, and "with Half up to 5.54", alias "towards";
        /// Light bleeding reduction: visibility up to this value becomes 0, and the rest is rescaled, which darkens edges.
        bleed: f32 = 0.2, 0..=0.95, in "fraction of the light";
        /// Difference below which two depths count as equal.
        bias: f32 = 0.0001, 0..=0.1, in "fraction of the depth range";
        /// Width of a texel of the moment map in texels of the depth map.
        downscale: u32 = 2, power_of_two 1..=4, in "texels";
        /// Radius of the blur, in texels of the moment map.
        blur_texels: u32 = 0, 0..=4, in "texels", and "downscale x (blur_texels + 1.5 x 2^(mips - 1)) up to 24";
        /// Mip levels of the moment map; distant surfaces read the smaller ones.
        mips: u32 = 2, 1..=3;
    }
}

declare_settings! {
    /// The moments that `evsm` stores.
    #[derive(Copy, Eq)]
    #[default(Four)]
    pub enum EvsmMoments {
        /// Depth warped by the positive exponent, and its square.
        Two;
        /// Depth warped by the negative exponent and its square as well: less light leaks near casters.
        Four;
    }
}

declare_settings! {
    /// The bits of each moment of `evsm`.
    #[derive(Copy, Eq)]
    #[default(Full)]
    pub enum EvsmPrecision {
        /// 16 bits: half of the memory, and more light leaks.
        Half;
        /// 32 bits.
        Full;
    }
}

impl EvsmSettings {
    fn check(&self) -> Result<(), Error> {
        let exponents =
            [("positive_exponent", self.positive_exponent), ("negative_exponent", self.negative_exponent)];
        let too_large = exponents.into_iter().find(|(_, exponent)| *exponent > 5.54);
        if let (EvsmPrecision::Half, Some((field, exponent))) = (self.precision, too_large) {
            return Err(refused(Self::SETTINGS, field, exponent));
        }
        self.moment_map().check(Self::SETTINGS)
    }
}

impl NamedSettings for EvsmSettings {
    const NAME: &'static str = "evsm";
}

impl Moments for EvsmSettings {
    const LAYOUTS: u32 = 4;

    fn modules(layout: u32) -> Vec<ModuleSource> {
        let (four, half) = (layout < 2, layout % 2 == 1);
        let source = format!(
            "#define_import_path shadowgraph::shadows::evsm_layout\n\
             const FOUR: bool = {four};\n\
             const HALF: bool = {half};\n"
        );
        vec![EVSM, ModuleSource::new(format!("shadows/evsm_layout.wgsl as {layout}"), source)]
    }

    fn format(layout: u32) -> Format {
        match layout {
            0 => Format::Rgba32Uint,
            3 => Format::R32Uint,
            _ => Format::Rg32Uint,
        }
    }

    fn layout(&self) -> u32 {
        let two = if self.moments == EvsmMoments::Two { 2 } else { 0 };
        two + u32::from(self.precision == EvsmPrecision::Half)
    }

    fn moment_map(&self) -> MomentMap {
        MomentMap { downscale: self.downscale, blur_texels: self.blur_texels, mips: self.mips }
    }
}
