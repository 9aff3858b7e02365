//! Conversion of skins.

use glam::{DAffine3, DMat4, DVec4};

use super::buffers::Buffers;
use super::error::{ImportError, WithLocation, describe};
use super::nodes::{SceneNode, numbers};
use super::validate::MAX_JOINTS;
use crate::animation::Skin;

/// How far the last row of an inverse bind matrix may be from 0 0 0 1.
const MAX_ROW_ERROR: f64 = 1e-4;

/// The skins of the drawn nodes.
#[derive(Debug, Default)]
pub(super) struct Skins {
    pub(super) skins: Vec<Skin>,
    /// Index of the skin of each skin of the file, if a drawn node with a mesh uses it.
    numbers: Vec<Option<usize>>,
}

impl Skins {
    /// Reads the skins that drawn nodes with a mesh use.
    ///
    /// # Errors
    /// The location names the invalid skin.
    pub(super) fn read(buffers: &Buffers<'_>, nodes: &[SceneNode]) -> Result<Self, ImportError> {
        let document = buffers.document();
        let node_numbers = numbers(document, nodes);
        let mut skins = Self { skins: Vec::new(), numbers: vec![None; document.skins.len()] };
        for scene_node in nodes {
            let Some(node) = document.nodes.get(scene_node.node) else { continue };
            let Some(index) = node.skin.filter(|_| node.mesh.is_some()).map(|skin| skin.value()) else {
                continue;
            };
            let Some(number @ None) = skins.numbers.get_mut(index) else { continue };
            *number = Some(skins.skins.len());
            skins.skins.push(read_skin(buffers, index, &node_numbers)?);
        }
        Ok(skins)
    }

    /// Returns a skin of the file.
    pub(super) fn get(&self, index: usize) -> Option<&Skin> {
        self.skins.get(self.number(index)?)
    }

    /// Returns the index of a skin of the file.
    pub(super) fn number(&self, index: usize) -> Option<usize> {
        self.numbers.get(index).copied().flatten()
    }
}

/// Reads a skin. `node_numbers` has the index of each node of the file in the hierarchy.
fn read_skin(
    buffers: &Buffers<'_>,
    index: usize,
    node_numbers: &[Option<usize>],
) -> Result<Skin, ImportError> {
    let name = |skin: &::gltf::json::Skin| describe("skin", index, skin.name.as_deref());
    let Some(skin) = buffers.document().skins.get(index) else {
        return Err(ImportError::new(describe("skin", index, None), "does not exist"));
    };
    let count = skin.joints.len();
    if !(1..=MAX_JOINTS).contains(&count) {
        return Err(ImportError::new(name(skin), format!("has {count} joints (allowed: 1 to {MAX_JOINTS})")));
    }
    let joint = |joint: &::gltf::json::Index<::gltf::json::Node>| {
        let number = node_numbers.get(joint.value()).copied().flatten();
        number.ok_or_else(|| {
            let reason = format!("joint {joint} is not in the drawn scene (allowed: nodes of the scene)");
            ImportError::new(name(skin), reason)
        })
    };
    let joints = skin.joints.iter().map(joint).collect::<Result<Vec<_>, _>>()?;
    let inverse_bind = match skin.inverse_bind_matrices.map(|accessor| accessor.value()) {
        None => vec![DAffine3::IDENTITY; count],
        Some(accessor) => inverse_bind(buffers, accessor, count)
            .with_location(|| format!("{} inverseBindMatrices (accessor {accessor})", name(skin)))?,
    };
    Ok(Skin { joints, inverse_bind })
}

fn inverse_bind(buffers: &Buffers<'_>, accessor: usize, count: usize) -> Result<Vec<DAffine3>, String> {
    let given = buffers.accessor_count(accessor)?;
    if given < count as u64 {
        return Err(format!(
            "has {given} matrices for {count} joints (allowed: at least one for each joint)"
        ));
    }
    let matrices = buffers
        .accessor(accessor, usize::try_from(given).unwrap_or(usize::MAX).min(MAX_JOINTS))?
        .matrices()?;
    let affine = |(joint, matrix): (usize, [f32; 16])| {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if !matrix.is_finite() {
            return Err(format!("matrix {joint} is not finite (allowed: finite numbers)"));
        }
        if !matrix.row(3).abs_diff_eq(DVec4::W, MAX_ROW_ERROR) {
            return Err(format!("the last row of matrix {joint} must be 0 0 0 1"));
        }
        Ok(DAffine3::from_mat4(matrix))
    };
    matrices.into_iter().take(count).enumerate().map(affine).collect()
}
