//! What moves in the demo scene: nodes that turn about an axis, with what is attached to them.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::builder::SceneBuilder;
use crate::insert::rotation_curve;
use shadowgraph_scene::animation::{Animation, Channel, LocalTransform, Node, Property};
use shadowgraph_scene::{Attachment, InstanceKey, LightKey};

/// The length of the animation, seconds. All motions fit into it a whole number of times.
const LENGTH_S: f64 = 12.0;
/// Keyframes per second of what swings.
const KEYS_PER_S: f64 = 8.0;

/// How a node turns.
#[derive(Clone, Copy, Debug)]
pub(super) enum Motion {
    /// By one turn about Y over the whole animation.
    Turn,
    /// To and fro about an axis.
    Swing {
        /// Unit length, in the node's space.
        axis: DVec3,
        /// The angle to each side, radians.
        angle: f64,
        /// The number of swings over the whole animation.
        swings: f64,
    },
}

impl Motion {
    /// Returns the rotation at a fraction of the animation; none at 0.
    fn rotation(self, fraction: f64) -> DQuat {
        match self {
            Self::Turn => DQuat::from_rotation_y(fraction * TAU),
            Self::Swing { axis, angle, swings } => {
                DQuat::from_axis_angle(axis, angle * (fraction * swings * TAU).sin())
            }
        }
    }

    fn keys(self) -> u32 {
        match self {
            Self::Turn => 4,
            Self::Swing { .. } => (LENGTH_S * KEYS_PER_S) as u32,
        }
    }
}

impl SceneBuilder {
    /// Adds a node that moves, and returns its index.
    pub(super) fn add_moving_node(&mut self, name: &str, at: DVec3, rest: DQuat, motion: Motion) -> usize {
        let node = self.add_node(name, None, at, rest);
        let keys = motion.keys();
        let fractions = (0..=keys).map(|key| f64::from(key) / f64::from(keys));
        let times_s = fractions.clone().map(|fraction| (fraction * LENGTH_S) as f32).collect();
        let values =
            fractions.flat_map(|fraction| (rest * motion.rotation(fraction)).as_quat().to_array()).collect();
        let channel = Channel { node, property: Property::Rotation, curve: rotation_curve(times_s, values) };
        let animations = &mut self.scene.hierarchy.animations;
        if animations.is_empty() {
            animations.push(Animation { name: Some("wind".to_owned()), channels: Vec::new() });
        }
        animations[0].channels.push(channel);
        node
    }

    /// Adds a node, and returns its index.
    pub(super) fn add_node(
        &mut self,
        name: &str,
        parent: Option<usize>,
        translation: DVec3,
        rotation: DQuat,
    ) -> usize {
        let local = LocalTransform::Parts { translation, rotation, scale: DVec3::ONE };
        let nodes = &mut self.scene.hierarchy.nodes;
        nodes.push(Node { name: name.to_owned(), parent, local, weights: Vec::new(), skin: None });
        nodes.len() - 1
    }

    pub(super) fn attach_instance(&mut self, node: usize, object: InstanceKey) {
        self.scene.hierarchy.instances.push(Attachment { node, object });
    }

    pub(super) fn attach_light(&mut self, node: usize, object: LightKey) {
        self.scene.hierarchy.lights.push(Attachment { node, object });
    }
}
