//! What a user can choose about shadows.

mod atlas;
mod bias;
mod cascades;
mod check;
mod cull;
mod depth;
mod lights;
mod own;

pub use atlas::{AtlasSettings, AtlasTiles};
pub use bias::{BiasMethod, BiasSettings, NormalBias};
pub use cascades::{
    CascadeBlend, CascadeFitting, CascadeSelection, CascadeSettings, MAX_CASCADE_LIGHTS, MAX_CASCADES,
    SplitScheme,
};
pub use cull::CullSettings;
pub use depth::DepthFormat;
pub use lights::{LightRef, LightShadows};
pub(crate) use own::failed;
pub use own::{OwnSettings, TechniqueSettings};

use serde::{Deserialize, Serialize};

use shadowgraph_scene::Light;

use crate::Error;
use crate::light_params::of_lights;
pub(crate) use check::{in_range, setting};

/// All settings of shadows: those of the shadow maps, and those that single techniques add. Files may leave out what they do
/// not change.
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
    /// The cascades of the brightest directional lights.
    pub cascades: CascadeSettings,
    /// The map that holds all other lights.
    pub atlas: AtlasSettings,
    /// What keeps surfaces from shadowing themselves.
    pub bias: BiasSettings,
    /// What single techniques have to choose, by their names.
    pub techniques: OwnSettings,
    /// Which casters are left out.
    pub cull: CullSettings,
    /// What is different for single lights.
    pub lights: Vec<LightShadows>,
}

impl Default for ShadowSettings {
    fn default() -> Self {
        Self {
            distance_m: 150.0,
            fade_fraction: 0.1,
            cascades: CascadeSettings::default(),
            atlas: AtlasSettings::default(),
            bias: BiasSettings::default(),
            techniques: OwnSettings::default(),
            cull: CullSettings::default(),
            lights: Vec::new(),
        }
    }
}

impl ShadowSettings {
    /// Checks every value but those of [`techniques`](Self::techniques), which [`Techniques::check`](crate::Techniques::check)
    /// knows.
    ///
    /// # Errors
    ///
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    pub fn validate(&self) -> Result<(), Error> {
        in_range("distance_m", self.distance_m, 0.001, 1e6, "0.001 to 1000000 (metres)")?;
        in_range("fade_fraction", self.fade_fraction, 0.001, 1.0, "0.001 to 1 (part of the distance)")?;
        self.cascades.validate()?;
        self.atlas.validate()?;
        self.bias.validate()?;
        self.lights.iter().try_for_each(LightShadows::validate)
    }

    /// Checks that a scene has each light that [`lights`](Self::lights) names, and that none is named twice.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownLight`] or [`Error::DuplicateLight`], with the entry.
    pub fn check_lights(&self, lights: &[Light]) -> Result<(), Error> {
        of_lights(self, lights).map(drop)
    }
}
