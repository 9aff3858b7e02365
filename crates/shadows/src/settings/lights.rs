//! Settings of single lights.

use serde::{Deserialize, Serialize};

use super::check::{in_range, in_range_if_some};
use crate::{Error, ShadowFilter};

/// What is different for one light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LightShadows {
    /// Which light.
    pub light: LightRef,
    /// Whether it casts shadows, if it may by itself.
    #[serde(default = "yes")]
    pub casts: bool,
    /// How dark its shadows are, 0 (none) to 1 (no light of it is left).
    #[serde(default = "one")]
    pub strength: f32,
    /// How its shadows' edges are smoothed; `Tent2` is what others call hard. Left out: as its map's.
    #[serde(default)]
    pub filter: Option<ShadowFilter>,
    /// Its constant bias, texels, 0 to 16. Left out: [`BiasSettings::depth_texels`](super::BiasSettings::depth_texels).
    #[serde(default)]
    pub depth_texels: Option<f32>,
    /// Its slope bias, 0 to 4. Left out: [`BiasSettings::slope`](super::BiasSettings::slope).
    #[serde(default)]
    pub slope: Option<f32>,
    /// Its normal bias, texels, 0 to 4. Left out: [`BiasSettings::normal_texels`](super::BiasSettings::normal_texels).
    #[serde(default)]
    pub normal_texels: Option<f32>,
    /// Where its depth range begins: for spot and point lights metres from the light, 0.0001 to 10,000, at most half of
    /// its range; for directional lights metres before where it would begin otherwise. Left out: as its map's.
    #[serde(default)]
    pub near_m: Option<f32>,
    /// How much more important than by its size on screen it is, 0 to 100.
    #[serde(default = "one")]
    pub importance: f32,
}

/// A light of the scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "`light` must be a light's number from 0, or its name in quotes")]
pub enum LightRef {
    /// Its place in the scene's list.
    Index(u32),
    /// Its name: the first light that has it.
    Name(String),
}

fn yes() -> bool {
    true
}

fn one() -> f32 {
    1.0
}

impl LightShadows {
    /// Makes settings of a light that change nothing yet.
    #[must_use]
    pub fn new(light: LightRef) -> Self {
        Self {
            light,
            casts: true,
            strength: 1.0,
            filter: None,
            depth_texels: None,
            slope: None,
            normal_texels: None,
            near_m: None,
            importance: 1.0,
        }
    }

    pub(super) fn validate(&self) -> Result<(), Error> {
        in_range("lights.strength", self.strength, 0.0, 1.0, "0 to 1")?;
        in_range_if_some("lights.depth_texels", self.depth_texels, 0.0, 16.0, "0 to 16 (texels)")?;
        in_range_if_some("lights.slope", self.slope, 0.0, 4.0, "0 to 4 (times the receiver's slope)")?;
        in_range_if_some("lights.normal_texels", self.normal_texels, 0.0, 4.0, "0 to 4 (texels)")?;
        in_range_if_some("lights.near_m", self.near_m, 1e-4, 1e4, "0.0001 to 10000 (metres)")?;
        in_range("lights.importance", self.importance, 0.0, 100.0, "0 to 100")
    }
}

impl std::fmt::Display for LightRef {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Index(index) => write!(f, "{index}"),
            Self::Name(name) => write!(f, "{name:?}"),
        }
    }
}

impl From<u32> for LightRef {
    fn from(index: u32) -> Self {
        Self::Index(index)
    }
}

impl From<&str> for LightRef {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}
