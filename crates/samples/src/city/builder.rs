//! The builder of a city: its scene, its meshes and materials, and the number of instances that are left.

use glam::{DAffine3, DQuat, DVec3};

use super::materials::Materials;
use super::shapes::{CityMesh, Shapes};
use crate::insert::insert_instance;
use shadowgraph_scene::animation::{Animation, Channel, LocalTransform, Node};
use shadowgraph_scene::{Attachment, InstanceKey, Light, MaterialKey, Scene};

/// The largest number of street lights.
const STREET_LIGHTS: usize = 1_000;
/// The number of street lights that cast shadows.
const SHADOWED_LIGHTS: usize = 64;

/// A city under construction.
pub(super) struct CityBuilder {
    scene: Scene,
    pub(super) materials: Materials,
    pub(super) shapes: Shapes,
    /// The number of instances that are still missing.
    left: usize,
    street_lights: usize,
    traffic: Vec<Channel>,
}

impl CityBuilder {
    /// Creates a scene without instances, which will have this many.
    pub(super) fn new(instances: usize) -> Self {
        let mut scene = Scene::default();
        let materials = Materials::new(&mut scene);
        let shapes = Shapes::new(&mut scene, &materials);
        Self { scene, materials, shapes, left: instances, street_lights: 0, traffic: Vec::new() }
    }

    /// Returns whether instances are still missing.
    pub(super) fn has_room(&self) -> bool {
        self.left > 0
    }

    pub(super) fn insert_light(&mut self, light: Light) {
        self.scene.insert_light(light);
    }

    /// Adds a street light unless there are enough. The first ones cast shadows.
    pub(super) fn insert_street_light(&mut self, light: Light) {
        if self.street_lights < STREET_LIGHTS {
            self.street_lights += 1;
            self.insert_light(Light { casts_shadow: self.street_lights <= SHADOWED_LIGHTS, ..light });
        }
    }

    /// Adds an instance of a part, in its own material or in another; `None` if there are enough.
    pub(super) fn add(
        &mut self,
        part: CityMesh,
        material: Option<MaterialKey>,
        transform: DAffine3,
    ) -> Option<InstanceKey> {
        self.left = self.left.checked_sub(1)?;
        Some(insert_instance(
            &mut self.scene,
            part.name,
            part.mesh,
            material.unwrap_or(part.material),
            transform,
        ))
    }

    /// Adds the parts of an object at one place; returns whether all fitted.
    pub(super) fn add_all(&mut self, parts: &[CityMesh], transform: DAffine3) -> bool {
        parts.iter().all(|&part| self.add(part, None, transform).is_some())
    }

    /// Adds a box of a size on the ground, turned about Y; returns whether it fitted.
    pub(super) fn add_box(&mut self, material: MaterialKey, foot: DVec3, size: DVec3) -> bool {
        let transform = DAffine3::from_scale_rotation_translation(size, DQuat::IDENTITY, foot);
        self.add(self.shapes.block, Some(material), transform).is_some()
    }

    /// Adds a node that an instance follows, and returns its index.
    pub(super) fn add_node(&mut self, name: &str, translation: DVec3, rotation: DQuat) -> usize {
        let local = LocalTransform::Parts { translation, rotation, scale: DVec3::ONE };
        let nodes = &mut self.scene.hierarchy.nodes;
        nodes.push(Node { name: name.to_owned(), parent: None, local, weights: Vec::new(), skin: None });
        nodes.len() - 1
    }

    /// Attaches an instance to a node.
    pub(super) fn attach(&mut self, node: usize, object: InstanceKey) {
        self.scene.hierarchy.instances.push(Attachment { node, object });
    }

    /// Adds the motion of nodes to the animation of the traffic.
    pub(super) fn animate(&mut self, channels: impl IntoIterator<Item = Channel>) {
        self.traffic.extend(channels);
    }

    pub(super) fn finish(mut self) -> Scene {
        let traffic = Animation { name: Some("traffic".to_owned()), channels: self.traffic };
        self.scene.hierarchy.animations.push(traffic);
        self.scene
    }
}
