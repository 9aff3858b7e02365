//! Settings of `msm`.

use serde::{Deserialize, Serialize};
use shadowgraph_core::Format;
use shadowgraph_shaders::{MSM, ModuleSource};

use super::{MomentParams, Moments};
use crate::error::Error;
use crate::settings::TechniqueSettings;
use crate::settings::in_range;

/// Settings of the technique `msm`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MsmSettings {
    /// The part of the light in a shadow that is taken for light that leaks, 0 to 0.95: edges get as much darker.
    pub bleed: f32,
    /// How far moments are moved to those that any depth could have, 0.00001 to 0.1: less, and rounding shows; more, and light
    /// leaks.
    pub bias: f32,
    /// How many texels of the map of depths a texel of moments stands for along each axis, 1, 2 or 4.
    pub downscale: u32,
    /// How many texels of moments edges are blurred over to either side, 0 to 4.
    pub blur_texels: u32,
    /// How many sizes of the map there are, each half of the one before, 1 to 3: far away the smaller ones are read.
    pub mips: u32,
}

impl Default for MsmSettings {
    fn default() -> Self {
        Self { bleed: 0.02, bias: 6e-5, downscale: 2, blur_texels: 0, mips: 2 }
    }
}

impl TechniqueSettings for MsmSettings {
    const NAME: &'static str = "msm";

    fn validate(&self) -> Result<(), Error> {
        in_range("bias", self.bias, 1e-5, 0.1, "0.00001 to 0.1")?;
        self.params().validate()
    }
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

    fn params(&self) -> MomentParams {
        MomentParams {
            exponents: [0.0; 2],
            bleed: self.bleed,
            bias: self.bias,
            downscale: self.downscale,
            radius: self.blur_texels,
            mips: self.mips,
            unused: 0,
        }
    }
}
