//! What a user can choose about shadows.

use serde::{Deserialize, Serialize};

use crate::Error;

/// All settings of the `pcf` technique. Files may leave out what they do not change.
///
/// ```
/// use shadowgraph_shadows::ShadowSettings;
/// let settings: ShadowSettings = ron::from_str("(distance_m: 60.0, cascades: (count: 2))")?;
/// settings.validate()?;
/// assert_eq!(settings.atlas.map_size_px, 2048);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ShadowSettings {
    /// How far from the camera there are shadows, metres of view depth, 0.001 to 1,000,000; at most the
    /// camera's far plane. The same for every kind of light.
    pub distance_m: f32,
    /// The last part of the distance, over which shadows fade out, 0.001 to 1.
    pub fade_fraction: f32,
    /// The cascades of the main directional light.
    pub cascades: CascadeSettings,
    /// The map that holds all other lights.
    pub atlas: AtlasSettings,
    /// What keeps surfaces from shadowing themselves.
    pub bias: BiasSettings,
}

/// The cascades of the main directional light: the brightest one that casts shadows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CascadeSettings {
    /// How many, 1 to 4.
    pub count: u32,
    /// Width of the map that holds them all, pixels, a power of two from 256 to 8192. With two or more
    /// cascades each has half of it.
    pub map_size_px: u32,
    /// Where one cascade ends and the next begins.
    pub split: SplitScheme,
}

/// How the shadow distance is divided among the cascades.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum SplitScheme {
    /// Fixed ratios for the number of cascades, which keep the texels about as large on screen everywhere:
    /// 0.25 for two, 0.1 and 0.35 for three, 0.067, 0.2 and 0.467 for four.
    #[default]
    Standard,
    /// The ends of all cascades but the last, as parts of the way from the near plane to the shadow distance:
    /// above 0, rising, below 1.
    Ratios(Vec<f32>),
    /// Between equal lengths (`lambda` 0) and equal factors (`lambda` 1).
    Practical {
        /// The weight of the logarithmic scheme, 0 to 1.
        lambda: f32,
    },
}

/// The atlas: one map for spot lights and further directional lights, up to 16 of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AtlasSettings {
    /// Width of the map, pixels, a power of two from 256 to 8192. It is split 1, 2, 3 or 4 times each way.
    pub map_size_px: u32,
    /// Where a spot light's depth range begins, metres from the light, 0.0001 to 100. Nearer casters count
    /// as being there.
    pub spot_near_m: f32,
}

/// What keeps surfaces from shadowing themselves. Lengths are in shadow texels of the tile in question.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct BiasSettings {
    /// How far the point that is looked up is moved along the triangle's normal, texels, 0 to 4. Scaled by
    /// the sine of the angle between normal and light.
    pub normal_texels: f32,
    /// How far each lookup of the filter is moved towards the light, in parts of the receiver's own depth
    /// change over its offset, 0 to 4. At 1 a flat surface never shadows itself.
    pub slope: f32,
    /// The flattest depth change, texels per texel, that lookups beside the middle allow for in every direction,
    /// 0 to 4. It keeps the foot of a lit wall from being darkened by the wall.
    pub min_slope: f32,
    /// The steepest depth change, texels per texel, that `slope` follows, 1 to 100.
    pub max_slope: f32,
    /// How far every lookup is moved towards the light, texels, 0 to 16.
    pub depth_texels: f32,
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self {
            distance_m: 150.0,
            fade_fraction: 0.1,
            cascades: CascadeSettings::default(),
            atlas: AtlasSettings::default(),
            bias: BiasSettings::default(),
        }
    }
}

impl Default for CascadeSettings {
    fn default() -> Self {
        Self { count: 4, map_size_px: 4096, split: SplitScheme::Practical { lambda: 0.85 } }
    }
}

impl Default for AtlasSettings {
    fn default() -> Self {
        Self { map_size_px: 2048, spot_near_m: 0.05 }
    }
}

impl Default for BiasSettings {
    fn default() -> Self {
        Self { normal_texels: 0.25, slope: 1.0, min_slope: 0.5, max_slope: 10.0, depth_texels: 0.25 }
    }
}

impl ShadowSettings {
    /// Checks every value.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    pub fn validate(&self) -> Result<(), Error> {
        in_range("distance_m", self.distance_m, 0.001, 1e6, "0.001 to 1000000 (metres)")?;
        in_range("fade_fraction", self.fade_fraction, 0.001, 1.0, "0.001 to 1 (part of the distance)")?;
        self.cascades.validate()?;
        map_size("atlas.map_size_px", self.atlas.map_size_px)?;
        in_range("atlas.spot_near_m", self.atlas.spot_near_m, 1e-4, 100.0, "0.0001 to 100 (metres)")?;
        self.bias.validate()
    }
}

impl CascadeSettings {
    fn validate(&self) -> Result<(), Error> {
        if !(1..=MAX_CASCADES).contains(&self.count) {
            return Err(setting("cascades.count", self.count, "1 to 4"));
        }
        map_size("cascades.map_size_px", self.map_size_px)?;
        match &self.split {
            SplitScheme::Standard => Ok(()),
            SplitScheme::Ratios(ratios) => check_ratios(ratios, self.count),
            SplitScheme::Practical { lambda } => {
                in_range("cascades.split.lambda", *lambda, 0.0, 1.0, "0 to 1 (0: equal lengths)")
            }
        }
    }
}

impl BiasSettings {
    fn validate(&self) -> Result<(), Error> {
        in_range("bias.normal_texels", self.normal_texels, 0.0, MAX_NORMAL_TEXELS, "0 to 4 (texels)")?;
        in_range("bias.slope", self.slope, 0.0, 4.0, "0 to 4 (times the receiver's slope)")?;
        in_range("bias.min_slope", self.min_slope, 0.0, 4.0, "0 to 4 (texels of depth per texel)")?;
        in_range("bias.max_slope", self.max_slope, 1.0, 100.0, "1 to 100 (texels of depth per texel)")?;
        in_range("bias.depth_texels", self.depth_texels, 0.0, 16.0, "0 to 16 (texels)")
    }
}

/// The most cascades there can be.
pub(crate) const MAX_CASCADES: u32 = 4;

/// The largest normal bias, texels: tiles of the smallest map still have room for it.
const MAX_NORMAL_TEXELS: f32 = 4.0;

fn setting(field: &'static str, value: impl ToString, allowed: &'static str) -> Error {
    Error::Setting { field, value: value.to_string(), allowed }
}

/// Refuses NaN too.
fn in_range(field: &'static str, value: f32, min: f32, max: f32, allowed: &'static str) -> Result<(), Error> {
    if (min..=max).contains(&value) { Ok(()) } else { Err(setting(field, value, allowed)) }
}

fn map_size(field: &'static str, size_px: u32) -> Result<(), Error> {
    if size_px.is_power_of_two() && (256..=8192).contains(&size_px) {
        Ok(())
    } else {
        Err(setting(field, size_px, "256, 512, 1024, 2048, 4096 or 8192 (pixels)"))
    }
}

fn check_ratios(ratios: &[f32], count: u32) -> Result<(), Error> {
    let rising = ratios.windows(2).all(|pair| pair[0] < pair[1]);
    let inside = ratios.iter().all(|ratio| *ratio > 0.0 && *ratio < 1.0);
    if ratios.len() + 1 == count as usize && rising && inside {
        return Ok(());
    }
    let value = format!("{ratios:?} for {count} cascades");
    Err(setting("cascades.split", value, "one ratio fewer than cascades, above 0, rising, below 1"))
}
