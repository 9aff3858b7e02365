//! Joints and weights of vertices.

use json::mesh::Semantic;

use ::gltf::json;

use super::super::error::{ImportError, WithLocation};
use super::{Reader, Source};
use crate::mesh::{Influence, SkinWeights, Vertex};

/// The number of attributes with four influences each that are read.
const SETS: u32 = 2;

impl Reader<'_> {
    /// Reads the influences of the vertices, if the primitive has them.
    ///
    /// # Errors
    /// The location names the invalid attribute.
    pub(super) fn skin(
        &mut self,
        source: &Source<'_>,
        vertices: &[Vertex],
    ) -> Result<Option<SkinWeights>, ImportError> {
        let sets = (0..SETS).take_while(|set| source.accessor(&Semantic::Joints(*set)).is_some());
        let sets = sets.map(|set| self.influences(source, set)).collect::<Result<Vec<_>, _>>()?;
        if sets.is_empty() {
            return Ok(None);
        }
        if source.accessor(&Semantic::Joints(SETS)).is_some() {
            self.notes.add(&source.location, "joints after the eighth of a vertex are ignored");
        }
        let vertex = |vertex: usize| sets.iter().filter_map(move |set| set.get(vertex)).flatten().copied();
        let influences = (0..source.count).flat_map(vertex).collect();
        let skin = SkinWeights::new(influences, sets.len() * 4, vertices);
        Ok(Some(skin.with_location(|| format!("{} WEIGHTS", source.location))?))
    }

    /// Reads four influences of each vertex.
    fn influences(&self, source: &Source<'_>, set: u32) -> Result<Vec<[Influence; 4]>, ImportError> {
        let weights = self.attribute(source, &Semantic::Weights(set), 4, [0.0; 4])?.ok_or_else(|| {
            let reason = format!("has JOINTS_{set} without WEIGHTS_{set} (allowed: both or neither)");
            ImportError::new(&source.location, reason)
        })?;
        let Some(accessor) = source.accessor(&Semantic::Joints(set)) else { return Ok(Vec::new()) };
        let location = || source.attribute_location(&format!("JOINTS_{set}"), accessor);
        let joints = self.vertex_elements(source, accessor).and_then(|accessor| accessor.joints());
        let joints = joints.with_location(location)?;
        let influences = |(joints, weights): ([u16; 4], [f32; 4])| -> [Influence; 4] {
            std::array::from_fn(|i| Influence { joint: joints[i].into(), weight: weights[i] })
        };
        Ok(joints.into_iter().zip(weights).map(influences).collect())
    }
}
