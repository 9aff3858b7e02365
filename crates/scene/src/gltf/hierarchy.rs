//! The nodes of the hierarchy, with what they animate and deform.

use ::gltf::json;

use super::document::Document;
use super::error::{ImportError, clean_name, describe};
use super::nodes::SceneNode;
use super::skins::Skins;
use super::validate::MAX_MORPH_WEIGHTS;
use crate::animation::Node;

/// Converts the drawn nodes.
///
/// # Errors
/// The location names the node or mesh whose weights do not fit its morph targets.
pub(super) fn nodes(
    document: &Document,
    scene_nodes: &[SceneNode],
    skins: &Skins,
) -> Result<Vec<Node>, ImportError> {
    let mut weights_left = MAX_MORPH_WEIGHTS;
    let mut nodes = Vec::with_capacity(scene_nodes.len());
    for scene_node in scene_nodes {
        let Some(node) = document.nodes.get(scene_node.node) else { continue };
        let mut weights = Vec::new();
        if let Some(index) = node.mesh.map(|mesh| mesh.value())
            && let Some(mesh) = document.meshes.get(index)
        {
            let count = target_count(mesh, index)?;
            weights_left = weights_left.checked_sub(count).ok_or_else(|| {
                ImportError::new("nodes", format!("over {MAX_MORPH_WEIGHTS} morph weights"))
            })?;
            weights = rest_weights(node, scene_node.node, mesh, index, count)?;
        }
        nodes.push(Node {
            name: clean_name(node.name.as_deref()),
            parent: scene_node.parent,
            local: scene_node.local,
            weights,
            skin: node.skin.and_then(|skin| skins.number(skin.value())),
        });
    }
    Ok(nodes)
}

/// Returns the number of morph targets of all primitives of a mesh.
fn target_count(mesh: &json::Mesh, index: usize) -> Result<usize, ImportError> {
    let mut counts =
        mesh.primitives.iter().map(|primitive| primitive.targets.as_ref().map_or(0, Vec::len)).enumerate();
    let Some((_, first)) = counts.next() else { return Ok(0) };
    match counts.find(|(_, count)| *count != first) {
        None => Ok(first),
        Some((primitive, count)) => {
            let location = format!("{} primitive {primitive}", describe("mesh", index, mesh.name.as_deref()));
            let reason = format!("has {count} morph targets (allowed: {first}, as primitive 0)");
            Err(ImportError::new(location, reason))
        }
    }
}

/// Returns the weights of the node, else those of its mesh, else zeros.
fn rest_weights(
    node: &json::Node,
    node_index: usize,
    mesh: &json::Mesh,
    mesh_index: usize,
    count: usize,
) -> Result<Vec<f32>, ImportError> {
    let (weights, location) = match (&node.weights, &mesh.weights) {
        (Some(weights), _) => (weights, describe("node", node_index, node.name.as_deref())),
        (None, Some(weights)) => (weights, describe("mesh", mesh_index, mesh.name.as_deref())),
        (None, None) => return Ok(vec![0.0; count]),
    };
    if weights.len() != count {
        let given = weights.len();
        let reason = format!("has {given} weights for {count} morph targets (allowed: one for each)");
        return Err(ImportError::new(location, reason));
    }
    if weights.iter().any(|weight| !weight.is_finite()) {
        return Err(ImportError::new(location, "has a weight that is not finite (allowed: finite numbers)"));
    }
    Ok(weights.clone())
}
