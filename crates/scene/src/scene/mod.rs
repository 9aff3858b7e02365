//! A scene: meshes, materials and images, their instances, lights and cameras.

mod by_name;
mod changes;
mod edit;
mod error;
mod hierarchy;
mod instance;
mod lights;
mod shadow_modes;
mod store;
#[cfg(test)]
mod tests;

pub use by_name::ByName;
pub use changes::Changes;
pub use error::EditError;
pub use hierarchy::{AnimationSelection, Attachment, Hierarchy};
pub use instance::{Instance, ShadowCasting};
pub use shadow_modes::{MaterialCasts, MaterialShadows, ObjectShadows, ShadowModes};

use lights::Lights;
use shadow_modes::{NamedModes, OwnOfInstance, OwnOfMaterial};
use store::Store;

use crate::bounds::{Aabb, ConvexVolume};
use crate::camera::Camera;
use crate::ground::GroundPlane;
use crate::keys::{ImageKey, InstanceKey, LightKey, MaterialKey, MeshKey};
use crate::light::Light;
use crate::material::{Image, Material};
use crate::mesh::Mesh;

/// Everything that a renderer needs to draw an image, as plain data.
///
/// Meshes, materials, images, instances and lights have keys that stay the same while others come and go. The scene notes what is
/// edited, so that copies of it, such as [`GpuScene`](crate::gpu::GpuScene), follow at a cost proportional to the edits:
/// see [`take_changes`](Self::take_changes).
///
/// ```
/// use glam::{DAffine3, DVec3};
/// use shadowgraph_scene::{Instance, Material, Mesh, Scene};
///
/// let mut scene = Scene::default();
/// let cube = scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, DVec3::ONE));
/// let white = scene.insert_material(Material::default())?;
/// let first = scene.insert_instance(Instance::new(cube, white, DAffine3::IDENTITY))?;
/// scene.insert_instance(Instance::new(cube, white, DAffine3::from_translation(DVec3::X * 3.0)))?;
/// scene.move_instance(first, DAffine3::from_translation(DVec3::Y))?;
/// scene.edit_instance(first, |instance| instance.receives_shadows = false)?;
/// // The second instance still uses the cube.
/// assert!(scene.remove_instance(first).is_ok() && scene.remove_mesh(cube).is_err());
/// # Ok::<(), shadowgraph_scene::EditError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    meshes: Store<MeshKey, Mesh>,
    materials: Store<MaterialKey, Material>,
    images: Store<ImageKey, Image>,
    instances: Store<InstanceKey, Instance>,
    lights: Lights,
    material_modes: NamedModes<MaterialKey, MaterialShadows, OwnOfMaterial>,
    object_modes: NamedModes<InstanceKey, ObjectShadows, OwnOfInstance>,
    /// The ground under a scene without a floor.
    pub ground: Option<GroundPlane>,
    /// The cameras of the file.
    pub cameras: Vec<Camera>,
    /// The contents of the file that are not drawn as it says, one line each.
    pub notes: Vec<String>,
    /// The nodes that instances, lights and cameras are attached to, and their animations.
    pub hierarchy: Hierarchy,
}

impl Scene {
    /// Returns the meshes.
    pub fn meshes(&self) -> impl ExactSizeIterator<Item = (MeshKey, &Mesh)> + Clone {
        self.meshes.iter()
    }

    /// Returns the materials.
    pub fn materials(&self) -> impl ExactSizeIterator<Item = (MaterialKey, &Material)> + Clone {
        self.materials.iter()
    }

    /// Returns the images.
    pub fn images(&self) -> impl ExactSizeIterator<Item = (ImageKey, &Image)> + Clone {
        self.images.iter()
    }

    /// Returns the instances.
    pub fn instances(&self) -> impl ExactSizeIterator<Item = (InstanceKey, &Instance)> + Clone {
        self.instances.iter()
    }

    /// Returns the lights in the order of their numbers: directional lights, then spot lights, then point lights, each kind as
    /// inserted.
    #[must_use]
    pub fn lights(&self) -> &[Light] {
        self.lights.as_slice()
    }

    /// Returns the key of each light, in the order of [`lights`](Self::lights).
    #[must_use]
    pub fn light_keys(&self) -> &[LightKey] {
        self.lights.keys()
    }

    /// Returns a mesh.
    #[must_use]
    pub fn mesh(&self, key: MeshKey) -> Option<&Mesh> {
        self.meshes.get(key)
    }

    /// Returns a material.
    #[must_use]
    pub fn material(&self, key: MaterialKey) -> Option<&Material> {
        self.materials.get(key)
    }

    /// Returns an image.
    #[must_use]
    pub fn image(&self, key: ImageKey) -> Option<&Image> {
        self.images.get(key)
    }

    /// Returns an instance.
    #[must_use]
    pub fn instance(&self, key: InstanceKey) -> Option<&Instance> {
        self.instances.get(key)
    }

    /// Returns the number of a light, its index in [`lights`](Self::lights). Edits of other lights may change it.
    #[must_use]
    pub fn light_index(&self, key: LightKey) -> Option<usize> {
        self.lights.index(key)
    }

    /// Returns the bounds of all instances; empty without any.
    #[must_use]
    pub fn bounds(&self) -> Aabb {
        self.instances().fold(Aabb::EMPTY, |bounds, (key, _)| bounds.union(&self.instance_bounds(key)))
    }

    /// Returns the world bounds of an instance in its pose; empty if there is no such instance, and for a hidden one.
    #[must_use]
    pub fn instance_bounds(&self, key: InstanceKey) -> Aabb {
        let Some(instance) = self.instance(key).filter(|instance| instance.visible) else {
            return Aabb::EMPTY;
        };
        self.local_bounds(key).transformed(&instance.world_from_local)
    }

    /// Returns the bounds of the mesh of an instance in its pose, in the space of the instance; empty if it does not exist.
    pub(crate) fn local_bounds(&self, key: InstanceKey) -> Aabb {
        let bounds = self.instance(key).and_then(|instance| {
            let mesh = self.mesh(instance.mesh)?;
            Some(instance.pose.as_ref().map_or(mesh.bounds, |pose| mesh.posed_bounds(pose)))
        });
        bounds.unwrap_or(Aabb::EMPTY)
    }

    /// Returns the instances whose bounds intersect the volume.
    pub fn visible_instances(&self, volume: &ConvexVolume) -> impl Iterator<Item = InstanceKey> {
        let visible = |key: &InstanceKey| volume.intersects(&self.instance_bounds(*key));
        self.instances().map(|(key, _)| key).filter(visible)
    }

    /// Returns the number of triangles over all instances.
    #[must_use]
    pub fn triangle_count(&self) -> u64 {
        let triangles = |mesh: MeshKey| self.mesh(mesh).map_or(0, |mesh| mesh.indices.len() as u64 / 3);
        self.instances().map(|(_, instance)| triangles(instance.mesh)).sum()
    }
}
