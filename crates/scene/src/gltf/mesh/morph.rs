//! Morph targets.

use super::super::error::{ImportError, WithLocation};
use super::super::validate::MAX_VERTICES;
use super::{Reader, Source};
use crate::mesh::{MorphDelta, MorphTarget};

impl Reader<'_> {
    /// Reads the morph targets of a primitive. Changes of attributes that the primitive lacks are ignored, as glTF says.
    ///
    /// # Errors
    /// The location names the invalid attribute.
    pub(super) fn morph_targets(
        &mut self,
        source: &Source<'_>,
        has_normals: bool,
        has_tangents: bool,
    ) -> Result<Vec<MorphTarget>, ImportError> {
        let json = source.primitive.targets.as_deref().unwrap_or_default();
        self.take_morph_vertices(source, source.count.saturating_mul(json.len()))?;
        let mut targets = Vec::with_capacity(json.len());
        for (i, target) in json.iter().enumerate() {
            let mut deltas = vec![MorphDelta::default(); source.count];
            let mut read = |name, accessor: Option<usize>, field: fn(&mut MorphDelta) -> &mut [f32; 3]| {
                let Some(accessor) = accessor else { return Ok(()) };
                let values = self.displacements(source, &format!("target {i} {name}"), accessor)?;
                deltas.iter_mut().zip(values).for_each(|(delta, value)| *field(delta) = value);
                Ok(())
            };
            read("POSITION", target.positions.map(|index| index.value()), |delta| &mut delta.position)?;
            let normals = target.normals.filter(|_| has_normals);
            read("NORMAL", normals.map(|index| index.value()), |delta| &mut delta.normal)?;
            let tangents = target.tangents.filter(|_| has_tangents);
            read("TANGENT", tangents.map(|index| index.value()), |delta| &mut delta.tangent)?;
            targets.push(MorphTarget::new(deltas));
        }
        Ok(targets)
    }

    fn displacements(
        &self,
        source: &Source<'_>,
        attribute: &str,
        accessor: usize,
    ) -> Result<Vec<[f32; 3]>, ImportError> {
        let location = || source.attribute_location(attribute, accessor);
        let values =
            self.vertex_elements(source, accessor).and_then(|accessor| accessor.vectors(3, [0.0; 3]));
        let values = values.with_location(location)?;
        match values.iter().position(|value| !value.iter().all(|x| x.is_finite())) {
            None => Ok(values),
            Some(vertex) => {
                let reason = format!("the change of vertex {vertex} is not finite (allowed: finite numbers)");
                Err(ImportError::new(location(), reason))
            }
        }
    }

    /// Counts displaced vertices against the limit of a scene.
    pub(super) fn take_morph_vertices(
        &mut self,
        source: &Source<'_>,
        count: usize,
    ) -> Result<(), ImportError> {
        let left = self.morph_vertices_left.checked_sub(count).ok_or_else(|| {
            let reason = format!("the morph targets of the scene have over {MAX_VERTICES} vertices");
            ImportError::new(&source.location, reason)
        })?;
        self.morph_vertices_left = left;
        Ok(())
    }
}
