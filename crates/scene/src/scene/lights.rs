//! Lights by stable keys, in the order of their numbers.

use slotmap::SlotMap;

use crate::keys::LightKey;
use crate::light::Light;

/// The lights of a scene: directional lights, then spot lights, then point lights, each kind in the order of insertion.
#[derive(Clone, Debug, Default)]
pub(super) struct Lights {
    lights: Vec<Light>,
    /// The key of each light.
    keys: Vec<LightKey>,
    /// The index of the light of each key.
    indices: SlotMap<LightKey, usize>,
}

impl PartialEq for Lights {
    fn eq(&self, other: &Self) -> bool {
        (&self.lights, &self.keys) == (&other.lights, &other.keys)
    }
}

impl Lights {
    pub(super) fn as_slice(&self) -> &[Light] {
        &self.lights
    }

    pub(super) fn keys(&self) -> &[LightKey] {
        &self.keys
    }

    pub(super) fn index(&self, key: LightKey) -> Option<usize> {
        self.indices.get(key).copied()
    }

    pub(super) fn insert(&mut self, light: Light) -> LightKey {
        let key = self.indices.insert(0);
        self.place(key, light);
        key
    }

    pub(super) fn replace(&mut self, key: LightKey, light: Light) -> Option<Light> {
        let index = self.index(key)?;
        if self.lights[index].kind.order() == light.kind.order() {
            return Some(std::mem::replace(&mut self.lights[index], light));
        }
        let previous = self.displace(index);
        self.place(key, light);
        Some(previous)
    }

    pub(super) fn remove(&mut self, key: LightKey) -> Option<Light> {
        let index = self.indices.remove(key)?;
        Some(self.displace(index))
    }

    /// Inserts a light after the others of its kind.
    fn place(&mut self, key: LightKey, light: Light) {
        let index = self.lights.partition_point(|other| other.kind.order() <= light.kind.order());
        self.lights.insert(index, light);
        self.keys.insert(index, key);
        self.number_from(index);
    }

    fn displace(&mut self, index: usize) -> Light {
        self.keys.remove(index);
        let light = self.lights.remove(index);
        self.number_from(index);
        light
    }

    /// Updates the indices of the lights from this one on.
    fn number_from(&mut self, first: usize) {
        for (index, key) in self.keys.iter().enumerate().skip(first) {
            self.indices.get_mut(*key).into_iter().for_each(|stored| *stored = index);
        }
    }
}
