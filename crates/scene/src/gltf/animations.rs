//! Conversion of animations.

use super::buffers::Buffers;
use super::document::{Channel as JsonChannel, Sampler};
use super::error::{ImportError, WithLocation, clean_name, describe};
use super::nodes::{SceneNode, numbers};
use super::notes::Notes;
use super::validate::MAX_KEYFRAME_VALUES;
use crate::animation::{Animation, Channel, Curve, Interpolation, LocalTransform, Node, Property};

/// Reads animations, and counts their numbers against the limit of a scene.
pub(super) struct Reader<'a> {
    buffers: &'a Buffers<'a>,
    notes: &'a mut Notes,
    /// The nodes of the hierarchy.
    nodes: &'a [Node],
    /// Index of each node of the file in the hierarchy.
    node_numbers: Vec<Option<usize>>,
    values_left: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(
        buffers: &'a Buffers<'a>,
        scene_nodes: &[SceneNode],
        nodes: &'a [Node],
        notes: &'a mut Notes,
    ) -> Self {
        let node_numbers = numbers(buffers.document(), scene_nodes);
        Self { buffers, notes, nodes, node_numbers, values_left: MAX_KEYFRAME_VALUES }
    }

    /// Reads all animations. Channels of nodes that are not drawn are left out.
    ///
    /// # Errors
    /// The location names the invalid channel.
    pub(super) fn animations(&mut self) -> Result<Vec<Animation>, ImportError> {
        let document = self.buffers.document();
        let mut animations = Vec::with_capacity(document.animations.len());
        for (i, animation) in document.animations.iter().enumerate() {
            let name = animation.name.as_deref();
            let mut channels = Vec::new();
            for (j, channel) in animation.channels.iter().enumerate() {
                let location = || format!("{} channel {j}", describe("animation", i, name));
                let Some((node, property)) = self.target(channel, &location) else { continue };
                let Some(sampler) = animation.samplers.get(channel.sampler.value()) else { continue };
                let curve = self.curve(sampler, node, property).with_location(location)?;
                channels.push(Channel { node, property, curve });
            }
            let name = name.map(|name| clean_name(Some(name)));
            animations.push(Animation { name, channels });
        }
        Ok(animations)
    }

    /// Returns the node and the property of a channel; `None`, with a note, for what cannot be played.
    fn target(&mut self, channel: &JsonChannel, location: &dyn Fn() -> String) -> Option<(usize, Property)> {
        let property = match channel.target.path.as_str() {
            "translation" => Property::Translation,
            "rotation" => Property::Rotation,
            "scale" => Property::Scale,
            "weights" => Property::Weights,
            path => {
                let path: String = path.chars().take(40).collect();
                self.notes.add(location(), format!("the path {path:?} is not played"));
                return None;
            }
        };
        let Some(target) = channel.target.node else {
            self.notes.add(location(), "a channel without a node is not played");
            return None;
        };
        let node = self.node_numbers.get(target.value()).copied().flatten()?;
        let matrix = matches!(self.nodes.get(node)?.local, LocalTransform::Matrix(_));
        if matrix && property != Property::Weights {
            self.notes.add(location(), "the transform of a node with a matrix is not played");
            return None;
        }
        Some((node, property))
    }

    fn curve(&mut self, sampler: &Sampler, node: usize, property: Property) -> Result<Curve, String> {
        let interpolation = match sampler.interpolation.as_deref() {
            None | Some("LINEAR") => Interpolation::Linear,
            Some("STEP") => Interpolation::Step,
            Some("CUBICSPLINE") => Interpolation::CubicSpline,
            Some(_) => return Err("unknown interpolation (allowed: LINEAR, STEP, CUBICSPLINE)".into()),
        };
        let width = match property {
            Property::Translation | Property::Scale => 3,
            Property::Rotation => 4,
            Property::Weights => self.nodes.get(node).map_or(0, |node| node.weights.len()),
        };
        if width == 0 {
            return Err("animates the weights of a node without morph targets".into());
        }
        let (input, output) = (sampler.input.value(), sampler.output.value());
        let at = |what, accessor| move |reason| format!("{what} (accessor {accessor}) {reason}");
        let times_s = self.buffers.accessor(input, self.values_left).and_then(|accessor| accessor.floats());
        let times_s = times_s.map_err(at("input", input))?;
        self.values_left -= times_s.len();
        let left = self.values_left;
        let per_element = if property == Property::Weights { width } else { 1 };
        let expected = times_s.len().saturating_mul(per_element * interpolation.values_per_key());
        let given = self.buffers.accessor_count(output)?;
        if given != expected as u64 {
            let keys = times_s.len();
            return Err(format!(
                "output (accessor {output}) has {given} elements for {keys} keyframes (allowed: {expected})"
            ));
        }
        let components = if property == Property::Weights { 1 } else { width };
        let values = self.buffers.accessor(output, left / components).and_then(|accessor| match property {
            Property::Translation | Property::Scale => accessor.vectors(3, [0.0; 3]).map(Vec::into_flattened),
            Property::Rotation => accessor.vectors(4, [0.0; 4]).map(Vec::into_flattened),
            Property::Weights => accessor.vectors(1, [0.0; 1]).map(Vec::into_flattened),
        });
        let values = values.map_err(at("output", output))?;
        self.values_left -= values.len();
        Curve::new(times_s, values, width, interpolation)
    }
}
