//! Animations: nodes whose transforms and weights change over time, as in glTF 2.0.

mod curve;
mod pose;

pub use curve::{Curve, Interpolation};
pub use pose::Pose;

use glam::{DAffine3, DQuat, DVec3};

/// A node: a transform relative to its parent, and the weights of the morph targets of its mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The name; empty without one.
    pub name: String,
    /// Index of the parent, below the node's own; `None` for a root.
    pub parent: Option<usize>,
    /// The transform at rest.
    pub local: LocalTransform,
    /// The weights at rest, one for each morph target.
    pub weights: Vec<f32>,
    /// Index of the skin that deforms the mesh of the node.
    pub skin: Option<usize>,
}

/// Nodes that move the vertices of meshes.
#[derive(Clone, Debug, PartialEq)]
pub struct Skin {
    /// Index of the node of each joint.
    pub joints: Vec<usize>,
    /// The transform from the space of the mesh to that of each joint at rest.
    pub inverse_bind: Vec<DAffine3>,
}

/// The transform from a node's space to its parent's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalTransform {
    /// Any affine transform. It cannot be animated.
    Matrix(DAffine3),
    /// First the scale, then the rotation, then the translation. Each can be animated.
    Parts {
        /// Metres.
        translation: DVec3,
        /// Of length 1.
        rotation: DQuat,
        /// The factor of each axis.
        scale: DVec3,
    },
}

/// The property of a node that a channel animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// The translation: three components, metres.
    Translation,
    /// The rotation: a quaternion x, y, z, w.
    Rotation,
    /// The scale: three components.
    Scale,
    /// The weights of the morph targets, a component for each.
    Weights,
}

/// The animation of one property of one node.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Index of the node.
    pub node: usize,
    /// The animated property.
    pub property: Property,
    /// The value over time.
    pub curve: Curve,
}

/// Channels that are played together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Animation {
    /// The name in the file.
    pub name: Option<String>,
    /// The animated properties.
    pub channels: Vec<Channel>,
}

impl Animation {
    /// Returns the time of the last keyframe of any channel, seconds; 0 without channels.
    #[must_use]
    pub fn end_s(&self) -> f32 {
        self.channels.iter().map(|channel| channel.curve.end_s()).fold(0.0, f32::max)
    }
}

impl Skin {
    /// Returns a transform near the joints, and for each joint the transform from the space of the mesh to the space of that
    /// transform. The transform is mirrored if the first joint mirrors the mesh, so that it has the winding of the triangles.
    #[must_use]
    pub fn pose(&self, world_from_node: &[DAffine3]) -> (DAffine3, Vec<DAffine3>) {
        let world = |node: &usize| world_from_node.get(*node).copied().unwrap_or(DAffine3::IDENTITY);
        let joints = self.joints.iter().zip(&self.inverse_bind);
        let mut joints: Vec<_> = joints.map(|(node, inverse_bind)| world(node) * *inverse_bind).collect();
        let is_mirrored = joints.first().is_some_and(|joint| joint.matrix3.determinant() < 0.0);
        let scale = DVec3::new(if is_mirrored { -1.0 } else { 1.0 }, 1.0, 1.0);
        let translation = self.joints.first().map_or(DVec3::ZERO, |node| world(node).translation);
        let world_from_local = DAffine3::from_scale_rotation_translation(scale, DQuat::IDENTITY, translation);
        for joint in &mut joints {
            joint.translation -= translation;
            *joint = DAffine3::from_scale(scale) * *joint;
        }
        (world_from_local, joints)
    }
}

impl LocalTransform {
    /// Returns the transform as one affine transform.
    #[must_use]
    pub fn to_affine(self) -> DAffine3 {
        match self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                DAffine3::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}
