//! The node hierarchy: which nodes are drawn, and where they are.

use ::gltf::json;
use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::document::Document;
use super::fault::{At, Fault, clean_name, fault, place};
use super::notes::Notes;
use super::validate::MAX_WORLD_M;
use super::{cameras, lights};
use crate::{Camera, Light};

/// A node of the drawn scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedNode {
    /// Index of the node in the file.
    pub(super) node: usize,
    pub(super) world_from_node: DAffine3,
}

/// Returns the nodes of the default scene, else of the first scene, else all nodes; parents before children.
///
/// # Errors
/// If the hierarchy is not a tree, or a transform is not finite.
pub(super) fn walk(document: &Document, notes: &mut Notes) -> Result<Vec<PlacedNode>, Fault> {
    let parents = parents(document)?;
    let mut placed = Vec::new();
    let roots = roots(document, &parents, notes)?;
    // A stack instead of recursion: a file may nest as deep as it is long.
    let mut open: Vec<(usize, DAffine3)> =
        roots.into_iter().rev().map(|node| (node, DAffine3::IDENTITY)).collect();
    while let Some((index, world_from_parent)) = open.pop() {
        let Some(node) = document.nodes.get(index) else { continue };
        let there = || place("node", index, node.name.as_deref());
        let world_from_node = world_from_parent * local_transform(node).at(there)?;
        check_range(&world_from_node).at(there)?;
        placed.push(PlacedNode { node: index, world_from_node });
        let children = node.children.iter().flatten().rev();
        open.extend(children.map(|child| (child.value(), world_from_node)));
    }
    Ok(placed)
}

/// Returns every node's parent, and makes sure that the nodes are trees.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, Fault> {
    let mut parents: Vec<Option<usize>> = vec![None; document.nodes.len()];
    for (i, node) in document.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let Some(parent) = parents.get_mut(child.value()) else { continue };
            if let Some(other) = parent.replace(i) {
                let reason =
                    format!("is a child of node {other} and again of node {i} (allowed: one parent)");
                return Err(fault(place("node", child.value(), None), reason));
            }
        }
    }
    // With at most one parent each, nodes that cannot be reached from a root are in or below a cycle.
    let mut reached = vec![false; parents.len()];
    let mut open: Vec<usize> = (0..parents.len()).filter(|i| parents.get(*i) == Some(&None)).collect();
    while let Some(index) = open.pop() {
        if let Some(reached) = reached.get_mut(index) {
            *reached = true;
        }
        let children = document.nodes.get(index).and_then(|node| node.children.as_ref());
        open.extend(children.into_iter().flatten().map(|child| child.value()));
    }
    match reached.iter().position(|reached| !reached) {
        None => Ok(parents),
        Some(lost) => Err(fault(place("node", lost, None), "is its own ancestor: the nodes form a cycle")),
    }
}

fn roots(document: &Document, parents: &[Option<usize>], notes: &mut Notes) -> Result<Vec<usize>, Fault> {
    let scene_index = document.scene.unwrap_or(0);
    let scene =
        usize::try_from(scene_index).ok().and_then(|index| document.scenes.get(index).zip(Some(index)));
    let Some((scene, index)) = scene else {
        return match (document.scene, document.scenes.len().checked_sub(1)) {
            (Some(scene), Some(last)) => {
                Err(fault("scene", format!("scene {scene} does not exist (allowed: 0 to {last})")))
            }
            (scene, _) => {
                if scene.is_some() {
                    notes.add("scene", "the default scene does not exist, all nodes are drawn");
                }
                Ok((0..parents.len()).filter(|i| parents.get(*i) == Some(&None)).collect())
            }
        };
    };
    let mut listed = vec![false; parents.len()];
    for node in &scene.nodes {
        let there = || place("scene", index, None);
        if let Some(Some(parent)) = parents.get(node.value()) {
            let reason =
                format!("lists node {node}, which is a child of node {parent} (allowed: root nodes)");
            return Err(fault(there(), reason));
        }
        if listed.get_mut(node.value()).is_some_and(|listed| std::mem::replace(listed, true)) {
            return Err(fault(there(), format!("lists node {node} twice")));
        }
    }
    Ok(scene.nodes.iter().map(|node| node.value()).collect())
}

/// Returns a node's transform from its own space to its parent's.
fn local_transform(node: &json::Node) -> Result<DAffine3, String> {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if matrix.row(3) != DVec4::W {
            return Err("the last row of its matrix is not 0 0 0 1, the only one allowed".into());
        }
        return Ok(DAffine3::from_mat4(matrix));
    }
    let vector = |value: Option<[f32; 3]>, default: DVec3| {
        value.map_or(default, |value| DVec3::from(value.map(f64::from)))
    };
    let rotation =
        node.rotation.map_or(DQuat::IDENTITY, |rotation| DQuat::from_array(rotation.0.map(f64::from)));
    let length = rotation.length();
    if !(length.is_finite() && length > 1e-6) {
        return Err(format!("its rotation has the length {length} (allowed: 1)"));
    }
    let (scale, translation) = (vector(node.scale, DVec3::ONE), vector(node.translation, DVec3::ZERO));
    Ok(DAffine3::from_scale_rotation_translation(scale, rotation / length, translation))
}

fn check_range(world: &DAffine3) -> Result<(), String> {
    let reach = |vector: DVec3| if vector.is_nan() { f64::NAN } else { vector.abs().max_element() };
    let axes = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis, world.translation];
    match axes.into_iter().map(reach).find(|reach| reach.is_nan() || *reach > MAX_WORLD_M) {
        None => Ok(()),
        Some(reach) => Err(format!("its transform reaches {reach:.3e} (allowed: up to {MAX_WORLD_M:e})")),
    }
}

/// Returns the lights of the drawn nodes: directional, spot, point, each in the order of the file.
///
/// # Errors
/// Names the light with a value that is not allowed, or the node that gives it no direction.
pub(super) fn lights(document: &Document, nodes: &[PlacedNode]) -> Result<Vec<Light>, Fault> {
    let lamps = document
        .lights()
        .iter()
        .enumerate()
        .map(|(i, light)| lights::lamp(light).at(|| place("light", i, light.name.as_deref())));
    let lamps: Vec<lights::Lamp> = lamps.collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    for (node, placed) in drawn(document, nodes) {
        let extension = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let Some(index) = extension.map(|extension| extension.light.value()) else { continue };
        let (Some(lamp), Some(light)) = (lamps.get(index), document.lights().get(index)) else { continue };
        let name = name_of(light.name.as_deref(), node);
        let light = lights::placed(lamp, name, &placed.world_from_node);
        found.push((index, light.at(|| place("node", placed.node, node.name.as_deref()))?));
    }
    found.sort_by_key(|(index, light)| (light.kind.order(), *index));
    Ok(found.into_iter().map(|(_, light)| light).collect())
}

/// Returns the cameras of the drawn nodes in the order of the file.
///
/// # Errors
/// Names the camera with a value that is not allowed, or the node that gives it no direction.
pub(super) fn cameras(document: &Document, nodes: &[PlacedNode]) -> Result<Vec<Camera>, Fault> {
    let lenses = document
        .cameras
        .iter()
        .enumerate()
        .map(|(i, camera)| cameras::projection(camera).at(|| place("camera", i, camera.name.as_deref())));
    let lenses: Vec<crate::Projection> = lenses.collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    for (node, placed) in drawn(document, nodes) {
        let Some(index) = node.camera.map(|camera| camera.value()) else { continue };
        let (Some(lens), Some(camera)) = (lenses.get(index), document.cameras.get(index)) else { continue };
        let name = name_of(camera.name.as_deref(), node);
        let camera = cameras::placed(*lens, name, &placed.world_from_node);
        found.push((index, camera.at(|| place("node", placed.node, node.name.as_deref()))?));
    }
    found.sort_by_key(|(index, _)| *index);
    Ok(found.into_iter().map(|(_, camera)| camera).collect())
}

fn drawn<'a>(
    document: &'a Document,
    nodes: &'a [PlacedNode],
) -> impl Iterator<Item = (&'a json::Node, &'a PlacedNode)> {
    nodes.iter().filter_map(|placed| Some((document.nodes.get(placed.node)?, placed)))
}

/// Returns the name of a light or camera, else of the node that it is at.
fn name_of(name: Option<&str>, node: &json::Node) -> Option<String> {
    name.or(node.name.as_deref()).map(|name| clean_name(Some(name)))
}
