//! Settings of single lights.

use serde::{Deserialize, Serialize};

use super::declare::DescribeSettings;
use super::describe::SettingType;
use super::filter::ShadowFilter;
use crate::declare_settings;
use crate::error::Error;

declare_settings! {
    /// Settings of one light.
    pub struct LightShadows {
        /// Light of the scene.
        required light: LightRef;
        /// Whether the light casts shadows, if the scene allows it.
        casts: bool = true;
        /// Darkness of the light's shadows: 0 for none, 1 for black.
        strength: f32 = 1.0, 0..=1;
        /// Filter of the light's shadow edges; `Tent2` is a hard filter. None: that of its map.
        filter: Option<ShadowFilter> = None;
        /// Constant bias. None: `bias.depth_texels`.
        depth_texels: Option<f32> = None, 0..=16, in "texels";
        /// Slope bias. None: `bias.slope`.
        slope: Option<f32> = None, 0..=4, in "times the receiver's slope";
        /// Normal bias. None: `bias.normal_texels`.
        normal_texels: Option<f32> = None, 0..=4, in "texels";
        /// Start of the depth range: for a spot or point light its distance from the light, at most half of the light's range; for a
        /// directional light the distance by which the range is extended towards the light. None: that of its map.
        near_m: Option<f32> = None, 0.0001..=10000, in "metres";
        /// Factor of the light's importance: the part of the image that it can fill, or the brightness of a directional light.
        importance: f32 = 1.0, 0..=100;
    }
}

/// A light of the scene.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged, expecting = "`light` must be a light's number from 0, or its name in quotes")]
pub enum LightRef {
    /// Its index in the scene's list.
    Index(u32),
    /// Its name: the first light that has it.
    Name(String),
}

impl DescribeSettings for LightRef {
    const TYPE: SettingType = SettingType::Other(None, "a light's number from 0, or its name in quotes");

    fn validate(&self) -> Result<(), Error> {
        Ok(())
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
