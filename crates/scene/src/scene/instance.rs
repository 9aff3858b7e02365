//! Drawn copies of meshes.

use glam::DAffine3;
use serde::{Deserialize, Serialize};

use crate::keys::{MaterialKey, MeshKey};
use crate::material::{CasterMode, Material};
use crate::mesh::MeshPose;

/// One drawn copy of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The name of the node in the file; empty if it has none.
    pub name: String,
    /// The mesh.
    pub mesh: MeshKey,
    /// The material.
    pub material: MaterialKey,
    /// The transform, in f64, absolute.
    pub world_from_local: DAffine3,
    /// How its mesh is deformed, if it is.
    pub pose: Option<MeshPose>,
    /// Whether it is drawn at all. A hidden instance casts no shadow either.
    pub visible: bool,
    /// Whether it casts shadows.
    pub casts: ShadowCasting,
    /// Whether it receives shadows, if its material does.
    pub receives_shadows: bool,
}

/// Whether an instance casts shadows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ShadowCasting {
    /// It casts the shadows of its material.
    #[default]
    On,
    /// It casts none.
    Off,
    /// It casts the shadows of its material, and is itself not seen.
    ShadowOnly,
}

impl Instance {
    /// Creates an instance without a name that is visible, and casts and receives shadows.
    #[must_use]
    pub fn new(mesh: MeshKey, material: MaterialKey, world_from_local: DAffine3) -> Self {
        Self {
            name: String::new(),
            mesh,
            material,
            world_from_local,
            pose: None,
            visible: true,
            casts: ShadowCasting::On,
            receives_shadows: true,
        }
    }

    /// Returns the instance with another name.
    #[must_use]
    pub fn with_name(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }

    /// Returns whether cameras see it.
    #[must_use]
    pub fn is_seen(&self) -> bool {
        self.visible && self.casts != ShadowCasting::ShadowOnly
    }

    /// Returns how it casts shadows, given its material.
    #[must_use]
    pub fn caster_mode(&self, material: &Material) -> CasterMode {
        if !self.visible || self.casts == ShadowCasting::Off {
            CasterMode::Off
        } else {
            material.caster_mode()
        }
    }
}
