//! Settings of shadows.
//!
//! Each setting is declared once, by [`declare_settings!`](crate::declare_settings); `describe` has what follows from that.

mod atlas;
mod bias;
mod cascades;
mod cull;
mod declare;
mod depth;
mod describe;
mod distance;
mod file;
mod filter;
mod lights;
mod modes;
mod technique;
mod tracks;

pub use atlas::{AtlasSettings, AtlasTiles};
pub use bias::{BiasMethod, BiasSettings, NormalBias};
pub use cascades::{
    CascadeBlend, CascadeFitting, CascadeSelection, CascadeSettings, MAX_CASCADE_LIGHTS, MAX_CASCADES,
    SplitScheme,
};
pub use cull::CullSettings;
pub use declare::{DescribeSettings, Given, SettingValue, json};
pub use depth::DepthFormat;
pub use describe::{Payload, Setting, SettingType, Variant, color, defaults};
pub(crate) use describe::{fields_schema, refused};
pub use distance::DistanceMeasure;
pub use file::settings_file;
pub use filter::{ShadowFilter, filter_taps};
pub use lights::{LightRef, LightShadows};
pub use modes::{MaterialModes, ObjectModes};
pub use technique::{NamedSettings, TechniqueSettings};
pub(crate) use technique::{failed, validate};
pub use tracks::{SettingTrack, SettingTracks, SettingZone, TrackValue};

use shadowgraph_scene::Light;

use crate::declare_settings;
use crate::error::Error;

declare_settings! {
    /// All settings of shadows: those of the shadow maps, and those of single techniques. Files may leave out any field.
    ///
    /// ```
    /// use shadowgraph_shadows::ShadowSettings;
    /// let settings: ShadowSettings = ron::from_str("(distance_m: 60.0, cascades: (count: 2))")?;
    /// settings.validate()?;
    /// assert_eq!(settings.atlas.map_size_px, 2048);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub struct ShadowSettings {
        /// Distance from the camera at which the shadows of all lights end, at most its far plane.
        distance_m: f32 = 150.0, 0.001..=1000000, in "metres";
        /// How the distance from the camera is measured.
        measure: DistanceMeasure = DistanceMeasure::ViewDepth;
        /// Last fraction of the distance, over which shadows fade out.
        fade_fraction: f32 = 0.1, 0.001..=1, in "fraction of the distance";
        /// Whether shadows are evaluated at four points of a pixel instead of one, where it is wider than two shadow texels.
        supersample: bool = true;
        /// Whether light is kept from leaking along the crease where a surface in shadow meets the one that hides it.
        close_creases: bool = true;
        /// Cascades of the brightest directional lights.
        cascades: CascadeSettings = CascadeSettings::default();
        /// Map that holds all other lights.
        atlas: AtlasSettings = AtlasSettings::default();
        /// Bias that keeps surfaces from shadowing themselves.
        bias: BiasSettings = BiasSettings::default();
        /// Settings of each technique, by name.
        techniques: TechniqueSettings = TechniqueSettings::default();
        /// Culling of casters.
        cull: CullSettings = CullSettings::default();
        /// Settings of single lights.
        lights: Vec<LightShadows> = Vec::new();
        /// Shadows of the materials with these names, in place of their own. Of all patterns that match a name, the last counts.
        materials: MaterialModes = MaterialModes::default();
        /// Shadows of the objects with these names, in place of their own. Of all patterns that match a name, the last counts.
        objects: ObjectModes = ObjectModes::default();
    }
}

impl ShadowSettings {
    /// Checks every value but those of [`techniques`](Self::techniques), whose types
    /// [`Techniques::check`](crate::Techniques::check) knows.
    ///
    /// # Errors
    /// [`Error::Setting`] names the first field that is out of its range, its value and the range.
    pub fn validate(&self) -> Result<(), Error> {
        DescribeSettings::validate(self)
    }

    /// Returns the settings with maps that are drawn in every frame, to measure or show how they are drawn.
    #[must_use]
    pub fn without_cache(&self) -> Self {
        let mut settings = self.clone();
        (settings.cascades.cache, settings.atlas.cache) = (false, false);
        settings
    }

    /// Checks that a scene has each light that [`lights`](Self::lights) names, and that none is named twice.
    ///
    /// # Errors
    ///
    /// [`Error::UnknownLight`] or [`Error::DuplicateLight`], with the entry.
    pub fn check_lights(&self, lights: &[Light]) -> Result<(), Error> {
        self.individual_settings(lights).map(drop)
    }

    /// Returns the individual settings of each light of the scene, `None` for lights without.
    ///
    /// # Errors
    /// If a light of the settings does not exist, or has two entries.
    pub(crate) fn individual_settings(&self, lights: &[Light]) -> Result<Vec<Option<&LightShadows>>, Error> {
        let mut by_light = vec![None; lights.len()];
        for (entry, own) in self.lights.iter().enumerate() {
            let index = match &own.light {
                LightRef::Index(index) => Some(*index as usize),
                LightRef::Name(name) => lights.iter().position(|light| light.name.as_ref() == Some(name)),
            };
            let slot = index.and_then(|index| Some((index, by_light.get_mut(index)?)));
            let Some((light, slot)) = slot else {
                return Err(Error::UnknownLight { entry, light: own.light.to_string(), count: lights.len() });
            };
            if slot.replace(own).is_some() {
                return Err(Error::DuplicateLight { entry, light });
            }
        }
        Ok(by_light)
    }
}

#[cfg(test)]
mod tests;
