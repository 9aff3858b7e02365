//! Shadow modes of materials and objects by name, in place of their own.

use serde::{Deserialize, Serialize};
use slotmap::{Key, SecondaryMap};

use super::by_name::ByName;
use super::instance::{Instance, ShadowCasting};
use super::store::Store;
use crate::material::{CasterMode, Material};

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

/// What has shadow modes that others can replace by name.
pub(super) trait Shadowed {
    /// The modes by name.
    type Modes: Copy;
    /// Its own modes.
    type Own: Copy;

    fn name(&self) -> &str;
    fn own(&self) -> Self::Own;
    fn set_own(&mut self, own: Self::Own);
    fn apply(&mut self, modes: Self::Modes);
}

/// The own modes of a material: what it casts, the cutoff of [`CasterMode::Clip`], and whether it receives shadows.
pub(super) type OwnOfMaterial = (Option<CasterMode>, Option<f32>, bool);

impl Shadowed for Material {
    type Modes = MaterialShadows;
    type Own = OwnOfMaterial;

    fn name(&self) -> &str {
        &self.name
    }

    fn own(&self) -> OwnOfMaterial {
        (self.casts, self.shadow_cutoff, self.receives_shadows)
    }

    fn set_own(&mut self, own: OwnOfMaterial) {
        (self.casts, self.shadow_cutoff, self.receives_shadows) = own;
    }

    fn apply(&mut self, modes: MaterialShadows) {
        if let Some(casts) = modes.casts {
            casts.apply_to(self);
        }
        self.receives_shadows = modes.receives.unwrap_or(self.receives_shadows);
    }
}

/// The own modes of an instance: what it casts, and whether it receives shadows.
pub(super) type OwnOfInstance = (ShadowCasting, bool);

impl Shadowed for Instance {
    type Modes = ObjectShadows;
    type Own = OwnOfInstance;

    fn name(&self) -> &str {
        &self.name
    }

    fn own(&self) -> OwnOfInstance {
        (self.casts, self.receives_shadows)
    }

    fn set_own(&mut self, own: OwnOfInstance) {
        (self.casts, self.receives_shadows) = own;
    }

    fn apply(&mut self, modes: ObjectShadows) {
        self.casts = modes.casts.unwrap_or(self.casts);
        self.receives_shadows = modes.receives.unwrap_or(self.receives_shadows);
    }
}

/// Modes by name, and the own modes of what has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct NamedModes<K: Key, M, O> {
    pub(super) modes: ByName<M>,
    own: SecondaryMap<K, O>,
}

impl<K: Key, M: Copy, O: Copy> NamedModes<K, M, O> {
    /// Gives the modes for its name to a value that has its own.
    pub(super) fn apply_to(&mut self, key: K, value: &mut impl Shadowed<Modes = M, Own = O>) {
        if let Some(&modes) = self.modes.get(value.name()) {
            self.own.insert(key, value.own());
            value.apply(modes);
        }
    }

    /// Gives the own modes of a value to a copy of it.
    pub(super) fn give_own(&self, key: K, copy: &mut impl Shadowed<Modes = M, Own = O>) {
        if let Some(&own) = self.own.get(key) {
            copy.set_own(own);
        }
    }

    /// Gives a value its own modes back.
    pub(super) fn restore(&mut self, key: K, value: &mut impl Shadowed<Modes = M, Own = O>) {
        self.give_own(key, value);
        self.own.remove(key);
    }

    /// Replaces all modes; logs the values that had or have some.
    pub(super) fn replace<T: Shadowed<Modes = M, Own = O>>(
        &mut self,
        modes: ByName<M>,
        values: &mut Store<K, T>,
    ) {
        for key in self.own.keys().collect::<Vec<_>>() {
            values.edit(key).into_iter().for_each(|value| self.restore(key, value));
        }
        self.modes = modes;
        let named = values.iter().filter(|(_, value)| self.modes.get(value.name()).is_some());
        for key in named.map(|(key, _)| key).collect::<Vec<_>>() {
            values.edit(key).into_iter().for_each(|value| self.apply_to(key, value));
        }
    }
}
