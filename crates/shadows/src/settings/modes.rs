//! Shadow modes of materials and objects by name.

use serde_json::{Map, Value};
use shadowgraph_scene::{ByName, MaterialCasts, MaterialShadows, ObjectShadows, ShadowModes};

use super::ShadowSettings;
use super::declare::DescribeSettings;
use super::describe::SettingType;
use crate::error::Error;

/// Shadow modes of materials by patterns of their names, in RON `{"leaves*": (casts: Clip(0.5), receives: false)}`.
pub type MaterialModes = ByName<MaterialShadows>;

/// Shadow modes of objects by patterns of their names, in RON `{"proxy*": (casts: ShadowOnly)}`.
pub type ObjectModes = ByName<ObjectShadows>;

impl DescribeSettings for MaterialModes {
    const TYPE: SettingType = SettingType::Other(
        Some(|| Value::Object(Map::new())),
        "a map from names of materials, with * and ?, to (casts: On, Clip(0 to 1), Dither, Tint or Off, receives: true or false)",
    );

    fn validate(&self) -> Result<(), Error> {
        for (pattern, shadows) in &self.0 {
            if let Some(MaterialCasts::Clip(cutoff)) = shadows.casts
                && !(0.0..=1.0).contains(&cutoff)
            {
                let field = format!("{pattern:?}.casts");
                return Err(Error::Setting {
                    field,
                    value: format!("Clip({cutoff})"),
                    allowed: "Clip(0 to 1)".into(),
                });
            }
        }
        Ok(())
    }
}

impl DescribeSettings for ObjectModes {
    const TYPE: SettingType = SettingType::Other(
        Some(|| Value::Object(Map::new())),
        "a map from names of objects, with * and ?, to (casts: On, Off or ShadowOnly, receives: true or false)",
    );

    /// Checks nothing: every value is allowed.
    fn validate(&self) -> Result<(), Error> {
        Ok(())
    }
}

impl ShadowSettings {
    /// Returns the shadow modes by name, for [`Scene::set_shadow_modes`](shadowgraph_scene::Scene::set_shadow_modes).
    #[must_use]
    pub fn shadow_modes(&self) -> ShadowModes {
        ShadowModes { materials: self.materials.clone(), objects: self.objects.clone() }
    }
}
