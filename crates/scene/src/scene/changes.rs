//! The log of edits.

use super::Scene;
use crate::keys::{ImageKey, InstanceKey, MaterialKey, MeshKey};

/// Keys of what was inserted, edited or removed, each once: a key that the scene no longer has was removed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// Keys of meshes.
    pub meshes: Vec<MeshKey>,
    /// Keys of materials.
    pub materials: Vec<MaterialKey>,
    /// Keys of images.
    pub images: Vec<ImageKey>,
    /// Keys of instances.
    pub instances: Vec<InstanceKey>,
}

impl Changes {
    /// Returns the insertion of everything that a scene has.
    #[must_use]
    pub fn insert_all(scene: &Scene) -> Self {
        Self {
            meshes: scene.meshes().map(|(key, _)| key).collect(),
            materials: scene.materials().map(|(key, _)| key).collect(),
            images: scene.images().map(|(key, _)| key).collect(),
            instances: scene.instances().map(|(key, _)| key).collect(),
        }
    }

    /// Returns whether nothing changed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.meshes.is_empty()
            && self.materials.is_empty()
            && self.images.is_empty()
            && self.instances.is_empty()
    }
}

impl Scene {
    /// Takes the log of edits since it was last taken, for the one copy of the scene that follows it: in a
    /// renderer that is the renderer itself. Lights are not logged, since every frame reads all of them.
    #[must_use]
    pub fn take_changes(&mut self) -> Changes {
        Changes {
            meshes: self.meshes.take_log(),
            materials: self.materials.take_log(),
            images: self.images.take_log(),
            instances: self.instances.take_log(),
        }
    }

    /// Returns changes to the log that were taken and could not be followed.
    pub fn restore_changes(&mut self, changes: Changes) {
        let Changes { meshes, materials, images, instances } = changes;
        self.meshes.restore_log(meshes);
        self.materials.restore_log(materials);
        self.images.restore_log(images);
        self.instances.restore_log(instances);
    }
}
