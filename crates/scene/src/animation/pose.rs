//! The nodes at a moment.

use glam::{DAffine3, DVec3};

use super::{Animation, Channel, LocalTransform, Node, Property};

/// The transforms and weights of nodes at a moment. Keep it from frame to frame: a pose of the same nodes allocates nothing.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pose {
    locals: Vec<LocalTransform>,
    world_from_node: Vec<DAffine3>,
    weights: Vec<Vec<f32>>,
}

impl Pose {
    /// Sets every node to its rest transform and weights, then plays animations at a time, seconds. Where several animate the same
    /// property, the last one counts. Channels of nodes that do not exist, or that have a matrix, are ignored.
    pub fn set<'a>(
        &mut self,
        nodes: &[Node],
        animations: impl IntoIterator<Item = &'a Animation>,
        time_s: f64,
    ) {
        self.locals.clear();
        self.locals.extend(nodes.iter().map(|node| node.local));
        self.weights.resize_with(nodes.len(), Vec::new);
        for (weights, node) in self.weights.iter_mut().zip(nodes) {
            weights.clone_from(&node.weights);
        }
        for channel in animations.into_iter().flat_map(|animation| &animation.channels) {
            self.play(channel, time_s);
        }
        self.world_from_node.clear();
        for (node, local) in nodes.iter().zip(&self.locals) {
            let parent = node.parent.and_then(|parent| self.world_from_node.get(parent));
            let world_from_parent = parent.copied().unwrap_or(DAffine3::IDENTITY);
            self.world_from_node.push(world_from_parent * local.to_affine());
        }
    }

    /// Returns the transform from each node's space to the world.
    #[must_use]
    pub fn world_from_node(&self) -> &[DAffine3] {
        &self.world_from_node
    }

    /// Returns the weights of a node's morph targets; empty if there is no such node.
    #[must_use]
    pub fn weights(&self, node: usize) -> &[f32] {
        self.weights.get(node).map_or(&[], Vec::as_slice)
    }

    fn play(&mut self, Channel { node, property, curve }: &Channel, time_s: f64) {
        let vector = || {
            let mut value = [0.0; 3];
            curve.sample(time_s, &mut value);
            DVec3::from_array(value)
        };
        let Some(local) = self.locals.get_mut(*node) else { return };
        match (property, local) {
            (Property::Translation, LocalTransform::Parts { translation, .. }) => *translation = vector(),
            (Property::Rotation, LocalTransform::Parts { rotation, .. }) => {
                *rotation = curve.sample_rotation(time_s);
            }
            (Property::Scale, LocalTransform::Parts { scale, .. }) => *scale = vector(),
            (Property::Weights, _) => {
                let weights = self.weights.get_mut(*node).into_iter().flatten();
                for (target, weight) in weights.enumerate() {
                    *weight = curve.sample_component(time_s, target) as f32;
                }
            }
            (_, LocalTransform::Matrix(_)) => {}
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

    use super::*;
    use crate::animation::{Curve, Interpolation};
    use glam::DQuat;
    use std::f64::consts::FRAC_PI_2;

    fn node(parent: Option<usize>, translation: DVec3) -> Node {
        let local = LocalTransform::Parts { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
        Node { name: String::new(), parent, local, weights: vec![0.25, 0.5], skin: None }
    }

    fn animation(node: usize, property: Property, width: usize, values: &[f32]) -> Animation {
        let curve = Curve::new(vec![0.0, 1.0], values.to_vec(), width, Interpolation::Linear).unwrap();
        Animation { name: None, channels: vec![Channel { node, property, curve }] }
    }

    #[test]
    fn children_move_with_their_parents() {
        let nodes = [node(None, DVec3::X), node(Some(0), DVec3::X), node(Some(1), DVec3::X)];
        let turned = DQuat::from_rotation_z(FRAC_PI_2).to_array().map(|number| number as f32);
        let turn = animation(0, Property::Rotation, 4, &[[0.0, 0.0, 0.0, 1.0], turned].concat());
        let stretch = animation(1, Property::Scale, 3, &[1.0, 1.0, 1.0, 3.0, 1.0, 1.0]);
        let mut pose = Pose::default();
        pose.set(&nodes, [&turn, &stretch], 1.0);
        let positions: Vec<_> = pose.world_from_node().iter().map(|world| world.translation).collect();
        for (position, expected) in positions.iter().zip([[1.0, 0.0], [1.0, 1.0], [1.0, 4.0]]) {
            assert!(position.abs_diff_eq(DVec3::new(expected[0], expected[1], 0.0), 1e-6), "{positions:?}");
        }
        pose.set(&nodes, [], 1.0);
        assert_eq!(pose.world_from_node()[2].translation, DVec3::X * 3.0);
    }

    #[test]
    fn the_last_animation_of_a_property_counts() {
        let nodes = [node(None, DVec3::ZERO)];
        let to = |x: f32| animation(0, Property::Translation, 3, &[0.0, 0.0, 0.0, x, 0.0, 0.0]);
        let mut pose = Pose::default();
        pose.set(&nodes, [&to(8.0), &to(2.0)], 0.5);
        assert_eq!(pose.world_from_node()[0].translation, DVec3::X);
    }

    #[test]
    fn weights_are_those_at_rest_or_animated() {
        let nodes = [node(None, DVec3::ZERO)];
        let weights = animation(0, Property::Weights, 2, &[0.0, 1.0, 1.0, 0.0]);
        let mut pose = Pose::default();
        pose.set(&nodes, [], 0.0);
        assert_eq!(pose.weights(0), [0.25, 0.5]);
        pose.set(&nodes, [&weights], 0.25);
        assert_eq!(pose.weights(0), [0.25, 0.75]);
        assert!(pose.weights(1).is_empty());
    }

    #[test]
    fn a_matrix_stays_and_missing_nodes_are_ignored() {
        let matrix = DAffine3::from_translation(DVec3::Y);
        let nodes = [Node { local: LocalTransform::Matrix(matrix), ..node(None, DVec3::ZERO) }];
        let moved = animation(0, Property::Translation, 3, &[5.0; 6]);
        let missing = animation(7, Property::Translation, 3, &[5.0; 6]);
        let mut pose = Pose::default();
        pose.set(&nodes, [&moved, &missing], 0.5);
        assert_eq!(pose.world_from_node(), [matrix]);
    }
}
