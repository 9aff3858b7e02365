//! The scene of a recording: what it is recognized by, and its edits.

use bytemuck::cast_slice;
use shadowgraph_scene::{Instance, InstanceKey, Light, Material, MaterialKey, Scene};
use xxhash_rust::xxh3::Xxh3;

use super::entry::{InstanceEdit, SceneEdits, SceneSummary};
use super::error::RecordingError;

impl SceneSummary {
    pub(crate) fn new(scene: &Scene) -> Self {
        let mut geometry = Xxh3::new();
        for (_, mesh) in scene.meshes() {
            geometry.update(cast_slice(&mesh.vertices));
            geometry.update(cast_slice(&mesh.indices));
        }
        Self {
            instances: scene.instances().len(),
            materials: scene.materials().len(),
            meshes: scene.meshes().len(),
            geometry: geometry.digest(),
        }
    }

    /// Checks that a scene is the same.
    pub(crate) fn check(&self, scene: &Scene) -> Result<(), RecordingError> {
        let own = Self::new(scene);
        let parts = [
            ("the numbers of instances", self.instances == own.instances),
            ("the numbers of materials", self.materials == own.materials),
            ("the numbers of meshes", self.meshes == own.meshes),
            ("the vertices", self.geometry == own.geometry),
        ];
        let other = parts.into_iter().find(|(_, same)| !same);
        other.map_or(Ok(()), |(what, _)| Err(RecordingError::OtherScene { what }))
    }
}

/// A scene as a recording knows it.
#[derive(Clone)]
pub(crate) struct KnownScene {
    instances: Vec<(InstanceKey, Instance)>,
    materials: Vec<(MaterialKey, Material)>,
    lights: Vec<Light>,
}

impl KnownScene {
    pub(crate) fn new(scene: &Scene) -> Self {
        let instance = |key| Some((key, scene.own_instance(key)?));
        let material = |key| Some((key, scene.own_material(key)?));
        Self {
            instances: scene.instances().filter_map(|(key, _)| instance(key)).collect(),
            materials: scene.materials().filter_map(|(key, _)| material(key)).collect(),
            lights: scene.lights().to_vec(),
        }
    }

    /// Returns the edits from the known scene to this one, which is known from now on.
    ///
    /// # Errors
    /// What a recording does not have.
    pub(crate) fn follow_all(&mut self, scene: &Scene) -> Result<SceneEdits, &'static str> {
        let instances: Vec<_> = scene.instances().map(|(key, _)| key).collect();
        let materials: Vec<_> = scene.materials().map(|(key, _)| key).collect();
        let mut edits = self.follow(scene, &instances, &materials)?;
        edits.instances.retain(|(_, edit)| *edit != InstanceEdit::default());
        edits.materials.retain(|(_, edited)| edited.is_some());
        Ok(edits)
    }

    /// Returns the edits of some instances and materials, and of the lights, since the scene was last known.
    ///
    /// # Errors
    /// What a recording does not have.
    pub(crate) fn follow(
        &mut self,
        scene: &Scene,
        instances: &[InstanceKey],
        materials: &[MaterialKey],
    ) -> Result<SceneEdits, &'static str> {
        let mut edits = SceneEdits::default();
        for &key in instances {
            let number = self.instances.binary_search_by_key(&key, |(key, _)| *key);
            let (Ok(number), Some(after)) = (number, scene.own_instance(key)) else {
                return Err("instances were inserted or removed");
            };
            let known = &mut self.instances[number].1;
            let edit = InstanceEdit::between(known, &after);
            *known = after;
            edits.instances.push((number, edit.ok_or("an instance got another mesh, material or name")?));
        }
        for &key in materials {
            let number = self.materials.binary_search_by_key(&key, |(key, _)| *key);
            let (Ok(number), Some(after)) = (number, scene.own_material(key)) else {
                return Err("materials were inserted or removed");
            };
            let known = &mut self.materials[number].1;
            let edited = (*known != after).then(|| after.clone());
            *known = after;
            edits.materials.push((number, edited));
        }
        self.follow_lights(scene.lights(), &mut edits);
        Ok(edits)
    }

    fn follow_lights(&mut self, lights: &[Light], edits: &mut SceneEdits) {
        let kinds = |lights: &[Light]| lights.iter().map(|light| light.kind.order()).collect::<Vec<_>>();
        if kinds(&self.lights) != kinds(lights) {
            edits.all_lights = Some(lights.to_vec());
        } else {
            let changed = (0..).zip(lights).zip(&self.lights).filter(|((_, light), known)| light != known);
            edits.lights = changed.map(|((number, light), _)| (number, light.clone())).collect();
        }
        if edits.all_lights.is_some() || !edits.lights.is_empty() {
            self.lights = lights.to_vec();
        }
    }
}

/// The keys of a scene by their numbers.
pub(crate) struct SceneKeys {
    instances: Vec<InstanceKey>,
    materials: Vec<MaterialKey>,
}

impl SceneKeys {
    pub(crate) fn new(scene: &Scene) -> Self {
        Self {
            instances: scene.instances().map(|(key, _)| key).collect(),
            materials: scene.materials().map(|(key, _)| key).collect(),
        }
    }

    /// Edits a scene.
    ///
    /// # Errors
    /// For an edit that the scene refuses.
    pub(crate) fn apply(
        &self,
        edits: &SceneEdits,
        scene: &mut Scene,
    ) -> Result<(), shadowgraph_scene::EditError> {
        for (number, edit) in &edits.instances {
            // A number out of range has a key that the scene refuses.
            let key = self.instances.get(*number).copied().unwrap_or_default();
            scene.edit_instance(key, |instance| edit.apply_to(instance))?;
        }
        for (number, edited) in &edits.materials {
            let key = self.materials.get(*number).copied().unwrap_or_default();
            scene.edit_material(key, |material| {
                edited.iter().for_each(|edited| material.clone_from(edited))
            })?;
        }
        if let Some(lights) = &edits.all_lights {
            scene.set_lights(lights.iter().cloned());
        }
        for (number, light) in &edits.lights {
            let key = scene.light_keys().get(*number).copied().unwrap_or_default();
            scene.replace_light(key, light.clone())?;
        }
        Ok(())
    }
}
