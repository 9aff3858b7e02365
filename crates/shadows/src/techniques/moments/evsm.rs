//! Settings of `evsm`, and the encodings of its moments.

use serde::{Deserialize, Serialize};
use shadowgraph_core::Format;
use shadowgraph_shaders::{EVSM, ModuleSource};

use super::{MomentParams, Moments};
use crate::error::Error;
use crate::settings::TechniqueSettings;
use crate::settings::in_range;

/// Settings of the technique `evsm`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EvsmSettings {
    /// Which moments there are.
    pub moments: EvsmMoments,
    /// In how many bits each is stored.
    pub precision: EvsmPrecision,
    /// How steeply depth is warped away from the light: the higher, the less light leaks where shadows overlap. 1 to 42, with
    /// [`EvsmPrecision::Half`] to 5.54: its squares must fit.
    pub away: f32,
    /// How steeply depth is warped towards the light, in the same ranges.
    pub towards: f32,
    /// The part of the light in a shadow that is taken for light that leaks, 0 to 0.95: edges get as much darker.
    pub bleed: f32,
    /// How far apart two depths are that count as one, parts of the tile's depth range, 0 to 0.1.
    pub bias: f32,
    /// How many texels of the map of depths a texel of moments stands for along each axis, 1, 2 or 4.
    pub downscale: u32,
    /// How many texels of moments edges are blurred over to either side, 0 to 4.
    pub blur_texels: u32,
    /// How many sizes of the map there are, each half of the one before, 1 to 3: far away the smaller ones are read.
    pub mips: u32,
}

/// Which moments `evsm` has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EvsmMoments {
    /// Depth warped away from the light, and its square.
    Two,
    /// Depth warped towards the light and its square besides: less light leaks near what casts shadows.
    #[default]
    Four,
}

/// In how many bits `evsm` stores a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum EvsmPrecision {
    /// 16: half of the memory, and more light leaks.
    Half,
    /// 32.
    #[default]
    Full,
}

impl Default for EvsmSettings {
    fn default() -> Self {
        Self {
            moments: EvsmMoments::default(),
            precision: EvsmPrecision::default(),
            away: 40.0,
            towards: 5.0,
            bleed: 0.2,
            bias: 1e-4,
            downscale: 2,
            blur_texels: 0,
            mips: 2,
        }
    }
}

impl TechniqueSettings for EvsmSettings {
    const NAME: &'static str = "evsm";

    fn validate(&self) -> Result<(), Error> {
        for (field, exponent) in [("away", self.away), ("towards", self.towards)] {
            match self.precision {
                EvsmPrecision::Half => {
                    in_range(field, exponent, 1.0, 5.54, "1 to 5.54 with Half, to 42 with Full")?
                }
                EvsmPrecision::Full => in_range(field, exponent, 1.0, 42.0, "1 to 42")?,
            }
        }
        in_range("bias", self.bias, 0.0, 0.1, "0 to 0.1 (part of the depth range)")?;
        self.params().validate()
    }
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

    fn params(&self) -> MomentParams {
        MomentParams {
            exponents: [self.away, self.towards],
            bleed: self.bleed,
            bias: self.bias,
            downscale: self.downscale,
            radius: self.blur_texels,
            mips: self.mips,
            unused: 0,
        }
    }
}
