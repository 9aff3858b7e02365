//! The triangles that ground truth is traced through, as a scene changes.

use std::collections::BTreeMap;

use glam::DVec3;
use shadowgraph::SceneRays;
use shadowgraph_scene::{Changes, Scene};
use shadowgraph_shadows::rays::{RayInstanceKey, RayScene};

use crate::Error;

/// The triangles of the scene that was followed last. It finds what has changed by comparison, as only the renderer reads a scene's log.
#[derive(Default)]
pub(crate) struct SceneTruth {
    followed: Option<(Scene, SceneRays)>,
}

impl SceneTruth {
    /// Follows a scene, and returns its triangles relative to `origin_world`.
    pub(crate) fn follow(&mut self, scene: &Scene, origin_world: DVec3) -> Result<&RayScene, Error> {
        let (kept, mut rays) = match self.followed.take() {
            Some((known, mut rays)) => {
                let changes = changes(&known, scene);
                rays.update(scene, &changes)?;
                (if changes.is_empty() { known } else { scene.clone() }, rays)
            }
            None => (scene.clone(), SceneRays::new(scene, origin_world)?),
        };
        rays.set_origin(origin_world)?;
        Ok(self.followed.insert((kept, rays)).1.rays())
    }

    /// Returns the name of the instance of the scene that is an instance of the triangles; without a name, its number among the instances.
    pub(crate) fn name(&self, key: RayInstanceKey) -> Option<String> {
        let (scene, rays) = self.followed.as_ref()?;
        let instance = rays.instance(key)?;
        let name = scene.instance(instance).map(|instance| instance.name.clone()).unwrap_or_default();
        if !name.is_empty() {
            return Some(name);
        }
        scene.instances().position(|(other, _)| other == instance).map(|number| format!("instance {number}"))
    }

    /// Returns the triangles that were followed last.
    pub(crate) fn rays(&self) -> Option<&RayScene> {
        self.followed.as_ref().map(|(_, rays)| rays.rays())
    }
}

/// Returns the edits from one scene to another.
fn changes(from: &Scene, to: &Scene) -> Changes {
    Changes {
        meshes: unlike(from.meshes(), to.meshes()),
        materials: unlike(from.materials(), to.materials()),
        images: unlike(from.images(), to.images()),
        instances: unlike(from.instances(), to.instances()),
    }
}

/// Returns the keys of values that only one side has, or that differ.
fn unlike<'v, K: Ord + Copy, V: PartialEq + 'v>(
    from: impl Iterator<Item = (K, &'v V)>,
    to: impl Iterator<Item = (K, &'v V)>,
) -> Vec<K> {
    let mut from: BTreeMap<K, &V> = from.collect();
    let mut keys: Vec<K> = to
        .filter(|(key, value)| from.remove(key).is_none_or(|old| old != *value))
        .map(|(key, _)| key)
        .collect();
    keys.extend(from.into_keys());
    keys
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use glam::{DAffine3, Vec3};
    use shadowgraph_samples::test_scenes::test_scene;
    use shadowgraph_scene::Instance;
    use shadowgraph_shadows::rays::Ray;

    /// Asserts that rays from `center` in all directions hit the same as in new trees.
    fn assert_as_new(truth: &mut SceneTruth, scene: &Scene, origin_world: DVec3) {
        let new = SceneRays::new(scene, origin_world).unwrap();
        let followed = truth.follow(scene, origin_world).unwrap();
        let center = (DVec3::new(0.2, 1.5, 0.1) - origin_world).as_vec3();
        let hits = (0..400).filter(|&index| {
            let turn = index as f32 * 2.4;
            let direction = Vec3::new(turn.cos(), index as f32 / 100.0 - 2.0, turn.sin()).normalize();
            let ray = Ray::new(center, direction, 0.0, f32::INFINITY);
            assert_eq!(followed.nearest_distance(&ray), new.rays().nearest_distance(&ray), "{direction}");
            followed.is_occluded(&ray)
        });
        assert!(hits.count() > 50);
    }

    #[test]
    fn the_truth_of_an_edited_scene_is_that_of_new_trees() {
        let mut scene = test_scene("columns").unwrap();
        let mut truth = SceneTruth::default();
        assert_as_new(&mut truth, &scene, DVec3::ZERO);
        let (key, first) = scene.instances().last().map(|(key, first)| (key, first.clone())).unwrap();
        scene.move_instance(key, DAffine3::from_translation(DVec3::new(0.5, 1.0, 0.0))).unwrap();
        assert_as_new(&mut truth, &scene, DVec3::ZERO);
        scene
            .insert_instance(Instance::new(
                first.mesh,
                first.material,
                DAffine3::from_scale(DVec3::splat(0.3)),
            ))
            .unwrap();
        scene.remove_instance(key).unwrap();
        assert_as_new(&mut truth, &scene, DVec3::ZERO);
        assert_as_new(&mut truth, &scene, DVec3::new(1024.0, 0.0, -1024.0));
        // A renderer's copy of another scene.
        assert_as_new(&mut truth, &test_scene("cube").unwrap(), DVec3::ZERO);
    }
}
