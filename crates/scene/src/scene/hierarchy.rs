//! The nodes of a scene, and what moves with them.

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::{EditError, Scene};
use crate::animation::{Animation, Node, Pose, Skin};
use crate::keys::{InstanceKey, LightKey};
use crate::light::Light;
use crate::mesh::MeshPose;
use crate::origin::MAX_WORLD_M;

/// The nodes of a scene, their animations, and what is attached to them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hierarchy {
    /// The nodes, parents before children.
    pub nodes: Vec<Node>,
    /// The skins, which nodes refer to by index.
    pub skins: Vec<Skin>,
    /// The animations of the file.
    pub animations: Vec<Animation>,
    /// The instances that are attached to nodes.
    pub instances: Vec<Attachment<InstanceKey>>,
    /// The lights that are attached to nodes.
    pub lights: Vec<Attachment<LightKey>>,
    /// The cameras that are attached to nodes.
    pub cameras: Vec<Attachment<usize>>,
}

/// The attachment of an instance, a light or a camera to the node that it moves with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Attachment<K> {
    /// Index of the node.
    pub node: usize,
    /// The key of the instance or light, or the index of the camera, in the scene.
    pub object: K,
}

/// The animations that are played.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnimationSelection {
    /// All at once. Where several animate the same property, the last one counts.
    #[default]
    All,
    /// None: nodes are at rest.
    None,
    /// The one with this index.
    One(usize),
}

impl Hierarchy {
    /// Returns the time of the last keyframe of the selected animations, seconds; 0 without any.
    #[must_use]
    pub fn end_s(&self, selection: AnimationSelection) -> f32 {
        self.selected(selection).map(Animation::end_s).fold(0.0, f32::max)
    }

    fn selected(&self, selection: AnimationSelection) -> impl Iterator<Item = &Animation> {
        let is_selected = move |index| match selection {
            AnimationSelection::All => true,
            AnimationSelection::None => false,
            AnimationSelection::One(one) => index == one,
        };
        let animations = self.animations.iter().enumerate();
        animations.filter(move |(index, _)| is_selected(*index)).map(|(_, animation)| animation)
    }

    /// Returns whether any animation moves each node.
    fn animated(&self) -> Vec<bool> {
        let mut animated = vec![false; self.nodes.len()];
        for channel in self.animations.iter().flat_map(|animation| &animation.channels) {
            animated.get_mut(channel.node).into_iter().for_each(|animated| *animated = true);
        }
        for (index, node) in self.nodes.iter().enumerate() {
            let parent = node.parent.and_then(|parent| animated.get(parent));
            if parent == Some(&true) {
                animated[index] = true;
            }
        }
        animated
    }
}

/// A new transform and pose of an instance.
type InstanceMove = (InstanceKey, DAffine3, Option<MeshPose>);

impl Scene {
    /// Poses the nodes of the hierarchy at a time: moves the instances, lights and cameras that are attached to animated nodes, and deforms
    /// the meshes whose joints or weights are animated. Before the first keyframe and after the last the values of these
    /// count. A light or camera whose node has the scale 0 keeps its direction. What no animation of the scene moves is not touched.
    ///
    /// # Errors
    /// [`EditError::OutOfRange`] if something is moved over 1e15 m from the world's origin; nothing is moved then.
    pub fn set_time(&mut self, selection: AnimationSelection, time_s: f64) -> Result<(), EditError> {
        if self.hierarchy.animations.is_empty() {
            return Ok(());
        }
        let mut pose = Pose::default();
        pose.set(&self.hierarchy.nodes, self.hierarchy.selected(selection), time_s);
        check_range(&self.hierarchy, &pose, time_s)?;
        let animated = self.hierarchy.animated();
        let moves = self.instance_moves(&pose, time_s, &animated)?;
        self.move_instances(moves)?;
        let is_animated = |node: usize| animated.get(node) == Some(&true);
        let world = |node: usize| pose.world_from_node().get(node).copied().filter(|_| is_animated(node));
        for Attachment { node, object } in self.hierarchy.lights.clone() {
            let light = self.light_index(object).and_then(|index| self.lights().get(index)).cloned();
            if let (Some(light), Some(world)) = (light, world(node)) {
                self.replace_light(object, Light { kind: light.kind.at_node(&world), ..light })?;
            }
        }
        for &Attachment { node, object } in &self.hierarchy.cameras {
            if let (Some(camera), Some(world)) = (self.cameras.get_mut(object), world(node)) {
                camera.follow(&world);
            }
        }
        Ok(())
    }

    /// Deforms all meshes that have a skin or morph targets as they are at rest.
    #[cfg(feature = "gltf")]
    pub(crate) fn deform_at_rest(&mut self) -> Result<(), EditError> {
        if !self.meshes().any(|(_, mesh)| mesh.skin.is_some() || !mesh.morph_targets.is_empty()) {
            return Ok(());
        }
        let mut pose = Pose::default();
        pose.set(&self.hierarchy.nodes, [], 0.0);
        let mut moves = self.instance_moves(&pose, 0.0, &vec![true; self.hierarchy.nodes.len()])?;
        moves.retain(|(_, _, pose)| pose.is_some());
        self.move_instances(moves)
    }

    /// Returns the new transforms and poses of the instances that are attached to these nodes, or are deformed by them.
    fn instance_moves(
        &self,
        pose: &Pose,
        time_s: f64,
        is_moved: &[bool],
    ) -> Result<Vec<InstanceMove>, EditError> {
        let hierarchy = &self.hierarchy;
        let moved = |node: &usize| is_moved.get(*node) == Some(&true);
        let mut skins: Vec<Option<(DAffine3, Arc<[DAffine3]>)>> = vec![None; hierarchy.skins.len()];
        let mut moves = Vec::new();
        for Attachment { node, object } in &hierarchy.instances {
            let Some(instance) = self.instance(*object) else { continue };
            let Some((mesh, data)) = self.mesh(instance.mesh).zip(hierarchy.nodes.get(*node)) else {
                continue;
            };
            let skin = data.skin.filter(|_| mesh.skin.is_some());
            let skin = skin.and_then(|index| Some((index, hierarchy.skins.get(index)?)));
            if !moved(node) && !skin.is_some_and(|(_, skin)| skin.joints.iter().any(moved)) {
                continue;
            }
            let (world_from_local, joints) = match skin {
                Some((index, skin)) => {
                    let pose = || {
                        let (world_from_local, joints) = skin.pose(pose.world_from_node());
                        (world_from_local, joints.into())
                    };
                    skins[index].get_or_insert_with(pose).clone()
                }
                None => (pose.world_from_node().get(*node).copied().unwrap_or_default(), Arc::default()),
            };
            let is_deformed = skin.is_some() || !mesh.morph_targets.is_empty();
            let pose = is_deformed.then(|| MeshPose { joints, weights: pose.weights(*node).to_vec() });
            let bounds = pose.as_ref().map_or(mesh.bounds, |pose| mesh.posed_bounds(pose));
            let bounds = bounds.transformed(&world_from_local);
            if !bounds.is_empty() && !in_range(&[bounds.min, bounds.max]) {
                return Err(out_of_range(hierarchy, *node, time_s));
            }
            if (world_from_local, &pose) != (instance.world_from_local, &instance.pose) {
                moves.push((*object, world_from_local, pose));
            }
        }
        Ok(moves)
    }

    fn move_instances(&mut self, moves: Vec<InstanceMove>) -> Result<(), EditError> {
        moves
            .into_iter()
            .try_for_each(|(key, world_from_local, pose)| self.pose_instance(key, world_from_local, pose))
    }
}

/// Checks that every node lies within the supported range.
fn check_range(hierarchy: &Hierarchy, pose: &Pose, time_s: f64) -> Result<(), EditError> {
    let lies_in_range = |world: &DAffine3| {
        in_range(&[world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis, world.translation])
    };
    match pose.world_from_node().iter().position(|world| !lies_in_range(world)) {
        None => Ok(()),
        Some(node) => Err(out_of_range(hierarchy, node, time_s)),
    }
}

/// Returns whether vectors are finite and not too long.
fn in_range(vectors: &[DVec3]) -> bool {
    vectors.iter().all(|vector| vector.abs().cmple(DVec3::splat(MAX_WORLD_M)).all())
}

fn out_of_range(hierarchy: &Hierarchy, node: usize, time_s: f64) -> EditError {
    let name = hierarchy.nodes.get(node).map_or("", |node| &node.name);
    EditError::OutOfRange { what: format!("node {node} \"{name}\" at {time_s} s") }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]

    use super::*;
    use crate::animation::{Channel, Curve, Interpolation, LocalTransform, Property};
    use crate::light::LightKind;
    use crate::material::Material;
    use crate::mesh::Mesh;
    use crate::{Camera, Projection};
    use glam::{DQuat, Vec3};

    fn node(parent: Option<usize>, translation: DVec3) -> Node {
        let local = LocalTransform::Parts { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
        Node { name: "n".into(), parent, local, weights: Vec::new(), skin: None }
    }

    fn animation(node: usize, property: Property, width: usize, values: &[f32]) -> Animation {
        let curve = Curve::new(vec![1.0, 2.0], values.to_vec(), width, Interpolation::Linear).unwrap();
        Animation { name: None, channels: vec![Channel { node, property, curve }] }
    }

    /// A cube, a spot light and a camera on a child of the animated node 0, and a cube on node 2, which does not move.
    fn scene(animations: Vec<Animation>) -> Scene {
        let mut scene = Scene::default();
        let mut add = || {
            let cube = Mesh::cuboid(DVec3::ZERO, DVec3::ONE);
            scene.add(cube, Material::default(), DAffine3::IDENTITY).unwrap()
        };
        let (moving, still) = (add(), add());
        let kind = LightKind::Spot {
            position_world: DVec3::ZERO,
            direction: DVec3::NEG_Z,
            range: None,
            inner_angle: 0.1,
            outer_angle: 0.2,
        };
        let light = Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true };
        let light = scene.insert_light(light);
        let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
        scene.cameras.push(Camera::look_at(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, projection));
        scene.hierarchy = Hierarchy {
            nodes: vec![node(None, DVec3::ZERO), node(Some(0), DVec3::Z), node(None, DVec3::X)],
            animations,
            instances: vec![Attachment { node: 1, object: moving }, Attachment { node: 2, object: still }],
            lights: vec![Attachment { node: 1, object: light }],
            cameras: vec![Attachment { node: 1, object: 0 }],
            ..Hierarchy::default()
        };
        scene
    }

    /// Returns the transform of the moving cube, 0, or of the other, 1.
    fn world(scene: &Scene, index: usize) -> DAffine3 {
        scene.instance(scene.hierarchy.instances[index].object).unwrap().world_from_local
    }

    /// Node 0 moves by 4 m along X, or turns by a right angle around Y.
    fn moves() -> Vec<Animation> {
        let turned = DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2).as_quat().to_array();
        vec![
            animation(0, Property::Translation, 3, &[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]),
            animation(0, Property::Rotation, 4, &[[0.0, 0.0, 0.0, 1.0], turned].concat()),
        ]
    }

    #[test]
    fn instances_lights_and_cameras_move_with_their_nodes() {
        let mut scene = scene(moves());
        scene.set_time(AnimationSelection::All, 2.0).unwrap();
        let position = DVec3::new(5.0, 0.0, 0.0);
        assert!(world(&scene, 0).translation.abs_diff_eq(position, 1e-6));
        let LightKind::Spot { position_world, direction, .. } = scene.lights()[0].kind else {
            unreachable!()
        };
        assert!(position_world.abs_diff_eq(position, 1e-6) && direction.abs_diff_eq(DVec3::NEG_X, 1e-6));
        let view = scene.cameras[0].world_from_view;
        assert!(view.translation.abs_diff_eq(position, 1e-6));
        assert!(view.matrix3.z_axis.abs_diff_eq(DVec3::X, 1e-6));
        assert_eq!(world(&scene, 1), DAffine3::IDENTITY, "no animation moves it");
    }

    #[test]
    fn the_selected_animations_are_played_from_their_first_to_their_last_keyframe() {
        let mut scene = scene(moves());
        let mut position = |selection, time_s| {
            scene.set_time(selection, time_s).unwrap();
            world(&scene, 0).translation
        };
        use AnimationSelection::{None, One};
        let cases = [(One(0), -5.0), (One(0), 1.5), (One(0), 99.0), (One(7), 2.0), (None, 2.0)];
        let found = cases.map(|(selection, time_s)| position(selection, time_s));
        let found = found.map(|at| (at * 16.0).round() / 16.0);
        let expected = [0.0, 2.0, 4.0, 0.0, 0.0].map(|x| DVec3::new(x, 0.0, 1.0));
        assert_eq!(found, expected);
        let ends = [AnimationSelection::All, None, One(1), One(2)].map(|s| scene.hierarchy.end_s(s));
        assert_eq!(ends, [2.0, 0.0, 2.0, 0.0]);
    }

    #[test]
    fn a_scale_of_zero_hides_an_instance_and_keeps_directions() {
        let mut scene = scene(vec![animation(0, Property::Scale, 3, &[1.0, 1.0, 1.0, 0.0, 0.0, 0.0])]);
        let before = scene.cameras[0].world_from_view.matrix3;
        scene.set_time(AnimationSelection::All, 3.0).unwrap();
        assert_eq!(world(&scene, 0).matrix3.determinant(), 0.0);
        let LightKind::Spot { position_world, direction, .. } = scene.lights()[0].kind else {
            unreachable!()
        };
        assert_eq!((position_world, direction), (DVec3::ZERO, DVec3::NEG_Z));
        assert_eq!(scene.cameras[0].world_from_view.matrix3, before);
    }

    #[test]
    fn a_transform_out_of_range_is_an_error_and_moves_nothing() {
        let far = animation(0, Property::Translation, 3, &[0.0, 0.0, 0.0, 1e30, 0.0, 0.0]);
        let mut scene = scene(vec![far]);
        let before = scene.clone();
        let error = scene.set_time(AnimationSelection::All, 1.5).unwrap_err().to_string();
        assert_eq!(
            error,
            "node 0 \"n\" at 1.5 s: it is moved over 1e15 m from the world's origin (allowed: up to 1e15 m)"
        );
        assert_eq!(scene, before);
    }
}
