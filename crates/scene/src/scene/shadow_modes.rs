//! Shadow modes of materials and objects by name, in place of their own.

use serde::de::{Deserializer, MapAccess, Visitor};
use serde::ser::Serializer;
use serde::{Deserialize, Serialize};
use slotmap::SecondaryMap;

use super::instance::{Instance, ShadowCasting};
use super::store::Store;
use crate::keys::{InstanceKey, MaterialKey};
use crate::material::{CasterMode, Material};

/// Values by patterns of names, in which `*` stands for any text and `?` for any character. Of all patterns that match a name, the last counts.
///
/// In files it is a map:
///
/// ```
/// use shadowgraph_scene::{ByName, MaterialShadows};
/// let modes: ByName<MaterialShadows> = ron::from_str(r#"{"*": (receives: true), "leaves*": (casts: Clip(0.3))}"#)?;
/// assert_eq!(modes.get("leaves of an oak").unwrap().receives, None);
/// assert_eq!(modes.get("bark").unwrap().receives, Some(true));
/// # Ok::<(), ron::error::SpannedError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ByName<T>(pub Vec<(String, T)>);

impl<T> Default for ByName<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<T> ByName<T> {
    /// Returns the value for a name.
    #[must_use]
    pub fn get(&self, name: &str) -> Option<&T> {
        self.0.iter().rev().find(|(pattern, _)| matches(pattern, name)).map(|(_, value)| value)
    }

    /// Returns the patterns that match none of the names.
    pub fn unused<'a>(
        &'a self,
        names: impl Iterator<Item = &'a str> + Clone,
    ) -> impl Iterator<Item = &'a str> {
        let patterns = self.0.iter().map(|(pattern, _)| pattern.as_str());
        patterns.filter(move |pattern| !names.clone().any(|name| matches(pattern, name)))
    }
}

/// Returns whether a pattern matches a name as a whole.
fn matches(pattern: &str, name: &str) -> bool {
    wildmatch::WildMatch::new(pattern).matches(name)
}

impl<T: Serialize> Serialize for ByName<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(pattern, value)| (pattern, value)))
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for ByName<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Entries<T>(std::marker::PhantomData<T>);

        impl<'de, T: Deserialize<'de>> Visitor<'de> for Entries<T> {
            type Value = ByName<T>;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("a map from patterns of names")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(ByName(entries))
            }
        }

        deserializer.deserialize_map(Entries(std::marker::PhantomData))
    }
}

/// The shadows of a material, where they are not as it says itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MaterialShadows {
    /// Kind of shadow that it casts.
    #[serde(with = "given", skip_serializing_if = "Option::is_none")]
    pub casts: Option<MaterialCasts>,
    /// Whether it receives shadows.
    #[serde(with = "given", skip_serializing_if = "Option::is_none")]
    pub receives: Option<bool>,
}

/// Kind of shadow that a material casts; see [`CasterMode`].
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum MaterialCasts {
    /// That of the whole surface.
    On,
    /// That of the surface where alpha is at least this, 0 to 1.
    Clip(f32),
    /// As dense as alpha.
    Dither,
    /// Coloured.
    Tint,
    /// None.
    Off,
}

impl MaterialCasts {
    pub(crate) fn apply_to(self, material: &mut Material) {
        material.casts = Some(match self {
            Self::On => CasterMode::On,
            Self::Clip(_) => CasterMode::Clip,
            Self::Dither => CasterMode::Dither,
            Self::Tint => CasterMode::Tint,
            Self::Off => CasterMode::Off,
        });
        if let Self::Clip(cutoff) = self {
            material.shadow_cutoff = Some(cutoff);
        }
    }
}

/// The shadows of an object, where they are not as it says itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ObjectShadows {
    /// Whether it casts shadows.
    #[serde(with = "given", skip_serializing_if = "Option::is_none")]
    pub casts: Option<ShadowCasting>,
    /// Whether it receives shadows, if its material does.
    #[serde(with = "given", skip_serializing_if = "Option::is_none")]
    pub receives: Option<bool>,
}

/// Reads and writes an optional field without `Some`: it is there or left out.
mod given {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<T: Serialize, S: Serializer>(
        value: &Option<T>,
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        match value {
            Some(value) => value.serialize(serializer),
            None => serializer.serialize_none(),
        }
    }

    pub(super) fn deserialize<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Option<T>, D::Error> {
        T::deserialize(deserializer).map(Some)
    }
}

/// Shadow modes by the names of materials and of instances.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowModes {
    /// Modes of materials.
    pub materials: ByName<MaterialShadows>,
    /// Modes of instances.
    pub objects: ByName<ObjectShadows>,
}

/// The shadow modes of a scene, and what they replace.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct AppliedModes {
    pub(super) modes: ShadowModes,
    materials: SecondaryMap<MaterialKey, (Option<CasterMode>, Option<f32>, bool)>,
    instances: SecondaryMap<InstanceKey, (ShadowCasting, bool)>,
}

impl AppliedModes {
    /// Gives the modes for its name to a material that has its own.
    pub(super) fn apply_to_material(&mut self, key: MaterialKey, material: &mut Material) {
        let Some(&modes) = self.modes.materials.get(&material.name) else { return };
        self.materials.insert(key, (material.casts, material.shadow_cutoff, material.receives_shadows));
        if let Some(casts) = modes.casts {
            casts.apply_to(material);
        }
        material.receives_shadows = modes.receives.unwrap_or(material.receives_shadows);
    }

    /// Gives the modes for its name to an instance that has its own.
    pub(super) fn apply_to_instance(&mut self, key: InstanceKey, instance: &mut Instance) {
        let Some(&modes) = self.modes.objects.get(&instance.name) else { return };
        self.instances.insert(key, (instance.casts, instance.receives_shadows));
        instance.casts = modes.casts.unwrap_or(instance.casts);
        instance.receives_shadows = modes.receives.unwrap_or(instance.receives_shadows);
    }

    /// Gives the own modes of a material to a copy of it.
    pub(super) fn give_own_to_material(&self, key: MaterialKey, copy: &mut Material) {
        if let Some(&own) = self.materials.get(key) {
            (copy.casts, copy.shadow_cutoff, copy.receives_shadows) = own;
        }
    }

    /// Gives the own modes of an instance to a copy of it.
    pub(super) fn give_own_to_instance(&self, key: InstanceKey, copy: &mut Instance) {
        if let Some(&own) = self.instances.get(key) {
            (copy.casts, copy.receives_shadows) = own;
        }
    }

    /// Gives a material its own modes back.
    pub(super) fn restore_material(&mut self, key: MaterialKey, material: &mut Material) {
        self.give_own_to_material(key, material);
        self.materials.remove(key);
    }

    /// Gives an instance its own modes back.
    pub(super) fn restore_instance(&mut self, key: InstanceKey, instance: &mut Instance) {
        self.give_own_to_instance(key, instance);
        self.instances.remove(key);
    }

    /// Replaces all modes; logs the materials and instances that had or have some.
    pub(super) fn replace(
        &mut self,
        modes: ShadowModes,
        materials: &mut Store<MaterialKey, Material>,
        instances: &mut Store<InstanceKey, Instance>,
    ) {
        for key in self.materials.keys().collect::<Vec<_>>() {
            materials.edit(key).into_iter().for_each(|material| self.restore_material(key, material));
        }
        for key in self.instances.keys().collect::<Vec<_>>() {
            instances.edit(key).into_iter().for_each(|instance| self.restore_instance(key, instance));
        }
        self.modes = modes;
        let named =
            materials.iter().filter(|(_, material)| self.modes.materials.get(&material.name).is_some());
        for key in named.map(|(key, _)| key).collect::<Vec<_>>() {
            materials.edit(key).into_iter().for_each(|material| self.apply_to_material(key, material));
        }
        let named = instances.iter().filter(|(_, instance)| self.modes.objects.get(&instance.name).is_some());
        for key in named.map(|(key, _)| key).collect::<Vec<_>>() {
            instances.edit(key).into_iter().for_each(|instance| self.apply_to_instance(key, instance));
        }
    }
}
