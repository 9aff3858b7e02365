//! Copies of a node's mesh by EXT_mesh_gpu_instancing.

use std::collections::BTreeMap;

use glam::{DQuat, DVec3};
use serde::Deserialize;

use super::buffers::Buffers;
use super::error::{ImportError, WithLocation, describe};
use super::nodes::{Role, SceneNode, check_range};
use super::validate::MAX_INSTANCES;
use crate::animation::LocalTransform;

const NAME: &str = "EXT_mesh_gpu_instancing";

/// The extension of a node, as in the file.
#[derive(Debug, Deserialize)]
#[serde(expecting = "an object of attributes")]
struct Instancing {
    /// The accessor of each attribute.
    attributes: BTreeMap<String, usize>,
}

/// Adds the copies of instanced nodes, as children of these.
///
/// # Errors
/// The location names the node and the attribute that is invalid.
pub(super) fn add_copies(buffers: &Buffers<'_>, nodes: &mut Vec<SceneNode>) -> Result<(), ImportError> {
    for number in 0..nodes.len() {
        let Some(SceneNode { node: index, world_from_node, .. }) = nodes.get(number).copied() else { break };
        let Some(node) = buffers.document().nodes.get(index).filter(|node| node.mesh.is_some()) else {
            continue;
        };
        let Some(value) = node.extensions.as_ref().and_then(|e| e.others.get(NAME)) else { continue };
        let location = || format!("{} {NAME}", describe("node", index, node.name.as_deref()));
        let copies = Instancing::deserialize(value)
            .map_err(|error| error.to_string())
            .and_then(|instancing| instancing.transforms(buffers, MAX_INSTANCES.saturating_sub(nodes.len())))
            .with_location(location)?;
        let Some(copies) = copies else { continue };
        nodes.get_mut(number).into_iter().for_each(|node| node.role = Role::Instanced);
        for local in copies {
            let world_from_node = world_from_node * local.to_affine();
            check_range(&world_from_node).with_location(location)?;
            let parent = Some(number);
            nodes.push(SceneNode { node: index, role: Role::Copy, parent, local, world_from_node });
        }
    }
    Ok(())
}

impl Instancing {
    /// Returns the transform of each copy in the space of its node; `None` if no attribute gives one.
    fn transforms(
        &self,
        buffers: &Buffers<'_>,
        max_count: usize,
    ) -> Result<Option<Vec<LocalTransform>>, String> {
        let translations = self.read(buffers, "TRANSLATION", [0.0; 3], max_count)?;
        let rotations = self.read(buffers, "ROTATION", [0.0; 4], max_count)?;
        let scales = self.read(buffers, "SCALE", [1.0; 3], max_count)?;
        let lengths = [
            translations.as_ref().map(Vec::len),
            rotations.as_ref().map(Vec::len),
            scales.as_ref().map(Vec::len),
        ];
        let mut lengths = lengths.into_iter().flatten();
        let Some(count) = lengths.next() else { return Ok(None) };
        if let Some(other) = lengths.find(|other| *other != count) {
            return Err(format!("has attributes of {count} and {other} elements (allowed: as many)"));
        }
        let vector = |values: &Option<Vec<[f32; 3]>>, i: usize, default: DVec3| {
            values.as_ref().and_then(|v| v.get(i)).map_or(default, |value| DVec3::from(value.map(f64::from)))
        };
        let transform = |i: usize| {
            let rotation = rotations.as_ref().and_then(|rotations| rotations.get(i));
            let rotation = rotation.map_or(DQuat::IDENTITY, |value| DQuat::from_array(value.map(f64::from)));
            let length = rotation.length();
            if !(length.is_finite() && length > 1e-6) {
                return Err(format!("ROTATION {i} has the length {length} (allowed: 1)"));
            }
            let (translation, scale) =
                (vector(&translations, i, DVec3::ZERO), vector(&scales, i, DVec3::ONE));
            Ok(LocalTransform::Parts { translation, rotation: rotation / length, scale })
        };
        (0..count).map(transform).collect::<Result<_, _>>().map(Some)
    }

    fn read<const N: usize>(
        &self,
        buffers: &Buffers<'_>,
        name: &str,
        fill: [f32; N],
        max_count: usize,
    ) -> Result<Option<Vec<[f32; N]>>, String> {
        let Some(index) = self.attributes.get(name) else { return Ok(None) };
        let values = buffers.accessor(*index, max_count).and_then(|accessor| accessor.vectors(N, fill));
        values.map(Some).map_err(|reason| format!("{name} (accessor {index}) {reason}"))
    }
}
