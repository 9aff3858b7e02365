//! What keeps surfaces from shadowing themselves.

use serde::{Deserialize, Serialize};

use super::check::in_range;
use crate::Error;

/// What keeps surfaces from shadowing themselves. Lengths are in shadow texels of the tile in question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BiasSettings {
    /// How lookups are moved towards the light.
    pub method: BiasMethod,
    /// How far the point that is looked up is moved along the triangle's normal, texels, 0 to 4; see `normal`.
    pub normal_texels: f32,
    /// What else `normal_texels` depends on.
    pub normal: NormalBias,
    /// How far each lookup of the filter is moved towards the light, in parts of the depth change that `method`
    /// follows, 0 to 4.
    pub slope: f32,
    /// The flattest depth change, texels per texel, that lookups beside the middle allow for in every direction,
    /// 0 to 4. It keeps the foot of a lit wall from being darkened by the wall. Only for `Plane`.
    pub min_slope: f32,
    /// The steepest depth change, texels per texel, that `slope` follows, 1 to 100.
    pub max_slope: f32,
    /// How far every lookup is moved towards the light, texels, 0 to 16.
    pub depth_texels: f32,
}

/// Which depth change a lookup is moved by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum BiasMethod {
    /// That of the receiver's plane from the middle of the filter to each of its texels: at `slope` 1 a flat surface
    /// never shadows itself.
    #[default]
    Plane,
    /// The steeper of the receiver's changes over one texel across and down, the same for the whole filter: what graphics
    /// hardware calls slope-scale bias.
    Slope,
    /// The change of what the map stores around the point, the same for the whole filter: gradient shadow maps (Schueler,
    /// "Eliminating Surface Acne with Gradient Shadow Maps", ShaderX4, 2006).
    Gradient,
}

/// What scales the bias along the normal.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum NormalBias {
    /// The sine of the angle between normal and light: surfaces that face the light need none.
    #[default]
    Sine,
    /// The diagonal of a texel and the filter, whatever the angle: √2 (1 + the filter's radius in texels).
    Filter,
}

/// The largest normal bias, texels: tiles of the smallest map still have room for it.
const MAX_NORMAL_TEXELS: f32 = 4.0;

impl Default for BiasSettings {
    fn default() -> Self {
        Self {
            method: BiasMethod::default(),
            normal_texels: 0.25,
            normal: NormalBias::default(),
            slope: 1.0,
            min_slope: 0.5,
            max_slope: 10.0,
            depth_texels: 0.25,
        }
    }
}

impl BiasSettings {
    pub(super) fn validate(&self) -> Result<(), Error> {
        in_range("bias.normal_texels", self.normal_texels, 0.0, MAX_NORMAL_TEXELS, "0 to 4 (texels)")?;
        in_range("bias.slope", self.slope, 0.0, 4.0, "0 to 4 (times the receiver's slope)")?;
        in_range("bias.min_slope", self.min_slope, 0.0, 4.0, "0 to 4 (texels of depth per texel)")?;
        in_range("bias.max_slope", self.max_slope, 1.0, 100.0, "1 to 100 (texels of depth per texel)")?;
        in_range("bias.depth_texels", self.depth_texels, 0.0, 16.0, "0 to 16 (texels)")
    }
}
