//! The node hierarchy: the nodes of the drawn scene and their transforms.

use ::gltf::json;
use glam::{DAffine3, DMat4, DQuat, DVec3, DVec4};

use super::document::Document;
use super::error::{ImportError, WithLocation, clean_name, describe};
use super::notes::Notes;
use super::validate::MAX_WORLD_M;
use super::{cameras, lights};
use crate::animation::LocalTransform;
use crate::camera::{Camera, Projection};
use crate::light::Light;

/// A node of the drawn scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct SceneNode {
    /// Index of the node in the file.
    pub(super) node: usize,
    pub(super) role: Role,
    /// Index of the parent among the nodes of the drawn scene.
    pub(super) parent: Option<usize>,
    pub(super) local: LocalTransform,
    pub(super) world_from_node: DAffine3,
}

/// What draws the mesh of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Role {
    /// The node itself.
    Node,
    /// The copies of the node.
    Instanced,
    /// This copy of a node, which is not in the file.
    Copy,
}

/// Returns the index of each node of the file among the nodes of the drawn scene.
pub(super) fn numbers(document: &Document, nodes: &[SceneNode]) -> Vec<Option<usize>> {
    let mut numbers = vec![None; document.nodes.len()];
    for (number, scene_node) in nodes.iter().enumerate().filter(|(_, node)| node.role != Role::Copy) {
        numbers.get_mut(scene_node.node).into_iter().for_each(|slot| *slot = Some(number));
    }
    numbers
}

/// Returns the nodes of the default scene, else of the first scene, else all nodes; parents before children.
///
/// # Errors
/// The hierarchy is not a tree, or a transform is not finite.
pub(super) fn walk(document: &Document, notes: &mut Notes) -> Result<Vec<SceneNode>, ImportError> {
    let parents = parents(document)?;
    let mut found = Vec::new();
    let roots = roots(document, &parents, notes)?;
    // A stack instead of recursion: a file may nest its nodes to any depth.
    let mut stack: Vec<(usize, Option<usize>, DAffine3)> =
        roots.into_iter().rev().map(|node| (node, None, DAffine3::IDENTITY)).collect();
    while let Some((index, parent, world_from_parent)) = stack.pop() {
        let Some(node) = document.nodes.get(index) else { continue };
        let location = || describe("node", index, node.name.as_deref());
        let local = local_transform(node).with_location(location)?;
        let world_from_node = world_from_parent * local.to_affine();
        check_range(&world_from_node).with_location(location)?;
        let number = found.len();
        found.push(SceneNode { node: index, role: Role::Node, parent, local, world_from_node });
        let children = node.children.iter().flatten().rev();
        stack.extend(children.map(|child| (child.value(), Some(number), world_from_node)));
    }
    Ok(found)
}

/// Returns the parent of every node after checking that the nodes form trees.
fn parents(document: &Document) -> Result<Vec<Option<usize>>, ImportError> {
    let mut parents: Vec<Option<usize>> = vec![None; document.nodes.len()];
    for (i, node) in document.nodes.iter().enumerate() {
        for child in node.children.iter().flatten() {
            let Some(parent) = parents.get_mut(child.value()) else { continue };
            if let Some(other) = parent.replace(i) {
                let reason =
                    format!("is a child of node {other} and again of node {i} (allowed: one parent)");
                return Err(ImportError::new(describe("node", child.value(), None), reason));
            }
        }
    }
    // With at most one parent each, nodes that cannot be reached from a root are in or below a cycle.
    let mut reached = vec![false; parents.len()];
    let mut stack: Vec<usize> = (0..parents.len()).filter(|i| parents.get(*i) == Some(&None)).collect();
    while let Some(index) = stack.pop() {
        if let Some(reached) = reached.get_mut(index) {
            *reached = true;
        }
        let children = document.nodes.get(index).and_then(|node| node.children.as_ref());
        stack.extend(children.into_iter().flatten().map(|child| child.value()));
    }
    match reached.iter().position(|reached| !reached) {
        None => Ok(parents),
        Some(lost) => {
            Err(ImportError::new(describe("node", lost, None), "is its own ancestor: the nodes form a cycle"))
        }
    }
}

fn roots(
    document: &Document,
    parents: &[Option<usize>],
    notes: &mut Notes,
) -> Result<Vec<usize>, ImportError> {
    let scene_index = document.scene.unwrap_or(0);
    let scene =
        usize::try_from(scene_index).ok().and_then(|index| document.scenes.get(index).zip(Some(index)));
    let Some((scene, index)) = scene else {
        return match (document.scene, document.scenes.len().checked_sub(1)) {
            (Some(scene), Some(last)) => {
                Err(ImportError::new("scene", format!("scene {scene} does not exist (allowed: 0 to {last})")))
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
        let location = || describe("scene", index, None);
        if let Some(Some(parent)) = parents.get(node.value()) {
            let reason =
                format!("lists node {node}, which is a child of node {parent} (allowed: root nodes)");
            return Err(ImportError::new(location(), reason));
        }
        if listed.get_mut(node.value()).is_some_and(|listed| std::mem::replace(listed, true)) {
            return Err(ImportError::new(location(), format!("lists node {node} twice")));
        }
    }
    Ok(scene.nodes.iter().map(|node| node.value()).collect())
}

/// Returns the transform from a node's space to its parent's.
fn local_transform(node: &json::Node) -> Result<LocalTransform, String> {
    if let Some(matrix) = &node.matrix {
        let matrix = DMat4::from_cols_array(&matrix.map(f64::from));
        if matrix.row(3) != DVec4::W {
            return Err("the last row of its matrix must be 0 0 0 1".into());
        }
        return Ok(LocalTransform::Matrix(DAffine3::from_mat4(matrix)));
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
    Ok(LocalTransform::Parts { translation, rotation: rotation / length, scale })
}

/// Checks that a transform is finite and within the supported range.
pub(super) fn check_range(world: &DAffine3) -> Result<(), String> {
    let extent = |vector: DVec3| if vector.is_nan() { f64::NAN } else { vector.abs().max_element() };
    let axes = [world.matrix3.x_axis, world.matrix3.y_axis, world.matrix3.z_axis, world.translation];
    match axes.into_iter().map(extent).find(|extent| extent.is_nan() || *extent > MAX_WORLD_M) {
        None => Ok(()),
        Some(extent) => {
            Err(format!("its transform extends to {extent:.3e} m (allowed: up to {MAX_WORLD_M:e} m)"))
        }
    }
}

/// Returns the lights of the drawn nodes, each with the index of its node: directional, spot, point, each in the order of the file.
///
/// # Errors
/// The location names the light with a value that is not allowed, or the node that gives it no direction.
pub(super) fn lights(
    document: &Document,
    nodes: &[SceneNode],
    notes: &mut Notes,
) -> Result<Vec<(usize, Light)>, ImportError> {
    let punctual = document.lights().iter().enumerate().map(|(i, light)| {
        let location = describe("light", i, light.name.as_deref());
        lights::convert(light, &location, notes).with_location(|| location)
    });
    let punctual: Vec<lights::PunctualLight> = punctual.collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    for (number, node, scene_node) in scene_nodes(document, nodes) {
        let extension = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
        let Some(index) = extension.map(|extension| extension.light.value()) else { continue };
        let (Some(punctual), Some(light)) = (punctual.get(index), document.lights().get(index)) else {
            continue;
        };
        let name = name_or_node_name(light.name.as_deref(), node);
        let light = lights::light_at_node(punctual, name, &scene_node.world_from_node);
        let light = light.with_location(|| describe("node", scene_node.node, node.name.as_deref()))?;
        found.push((index, number, light));
    }
    found.sort_by_key(|(index, _, light)| (light.kind.order(), *index));
    Ok(found.into_iter().map(|(_, number, light)| (number, light)).collect())
}

/// Returns the cameras of the drawn nodes, each with the index of its node, in the order of the file.
///
/// # Errors
/// The location names the camera with a value that is not allowed, or the node that gives it no direction.
pub(super) fn cameras(document: &Document, nodes: &[SceneNode]) -> Result<Vec<(usize, Camera)>, ImportError> {
    let projections = document.cameras.iter().enumerate().map(|(i, camera)| {
        cameras::projection(camera).with_location(|| describe("camera", i, camera.name.as_deref()))
    });
    let projections: Vec<Projection> = projections.collect::<Result<_, _>>()?;
    let mut found = Vec::new();
    for (number, node, scene_node) in scene_nodes(document, nodes) {
        let Some(index) = node.camera.map(|camera| camera.value()) else { continue };
        let (Some(projection), Some(camera)) = (projections.get(index), document.cameras.get(index)) else {
            continue;
        };
        let name = name_or_node_name(camera.name.as_deref(), node);
        let camera = cameras::camera_at_node(*projection, name, &scene_node.world_from_node);
        let camera = camera.with_location(|| describe("node", scene_node.node, node.name.as_deref()))?;
        found.push((index, number, camera));
    }
    found.sort_by_key(|(index, ..)| *index);
    Ok(found.into_iter().map(|(_, number, camera)| (number, camera)).collect())
}

/// Returns the index of each drawn node, and the node in the file.
fn scene_nodes<'a>(
    document: &'a Document,
    nodes: &'a [SceneNode],
) -> impl Iterator<Item = (usize, &'a json::Node, &'a SceneNode)> {
    let nodes = nodes.iter().enumerate();
    nodes.filter_map(|(number, node)| Some((number, document.nodes.get(node.node)?, node)))
}

/// Returns the name of a light or camera, else the name of its node.
fn name_or_node_name(name: Option<&str>, node: &json::Node) -> Option<String> {
    name.or(node.name.as_deref()).map(|name| clean_name(Some(name)))
}
