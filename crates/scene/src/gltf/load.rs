//! The import, step by step.

use std::path::Path;

use super::buffers::Buffers;
use super::document::Document;
use super::fault::{Fault, clean_name, fault, place};
use super::files::{Files, read_file};
use super::mesh::Reader;
use super::nodes::{self, PlacedNode};
use super::notes::Notes;
use super::validate::{MAX_BYTES, MAX_INSTANCES, MAX_WORLD_M, SUPPORTED_EXTENSIONS};
use super::{container, images, materials};
use crate::{Error, Instance, Material, Mesh, Scene};

/// How far loading is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// What is being done: "reading", "meshes", "images".
    pub stage: &'static str,
    /// How much of the stage is done, 0 to 1.
    pub fraction: f32,
}

/// Loads a glTF or GLB file.
///
/// Files that it refers to are read from its own folder only.
///
/// # Errors
/// One line: the file, the place in it, and what is wrong there.
///
/// ```
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("empty.gltf");
/// std::fs::write(&file, r#"{"asset": {"version": "2.0"}, "scenes": [{}]}"#)?;
/// let scene = shadowgraph_scene::gltf::load(&file)?;
/// assert!(scene.bounds().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load(path: &Path) -> Result<Scene, Error> {
    load_with_progress(path, &mut |_| {})
}

/// Loads a glTF or GLB file, and tells `progress` how far it is, always on the calling thread.
///
/// # Errors
/// As [`load`].
pub fn load_with_progress(path: &Path, progress: &mut dyn FnMut(Progress)) -> Result<Scene, Error> {
    let unreadable = |source| Error::Read { file: path.to_owned(), source };
    progress(Progress { stage: "reading", fraction: 0.0 });
    let bytes = read_file(path, MAX_BYTES).map_err(unreadable)?;
    let files = Files::beside(path, MAX_BYTES.saturating_sub(bytes.len() as u64)).map_err(unreadable)?;
    progress(Progress { stage: "reading", fraction: 1.0 });
    import(&bytes, &files, progress).map_err(|Fault { place, reason }| Error::Invalid {
        file: path.to_owned(),
        place,
        reason,
    })
}

fn import(bytes: &[u8], files: &Files, progress: &mut dyn FnMut(Progress)) -> Result<Scene, Fault> {
    let parts = container::split(bytes)?;
    let document = Document::parse(parts.json)?;
    let mut notes = Notes::default();
    note_what_is_not_drawn(&document, &mut notes);
    let nodes = nodes::walk(&document, &mut notes)?;
    check_instance_count(&document, &nodes)?;
    let lights = nodes::lights(&document, &nodes)?;
    let cameras = nodes::cameras(&document, &nodes)?;
    let materials::Materials { mut materials, images } = materials::read(&document, &mut notes)?;
    let buffers = Buffers::read(&document, parts.bin, files)?;
    let geometry = Geometry::read(&buffers, &nodes, &mut materials, &mut notes, progress)?;
    let instances = geometry.instances(&document, &nodes)?;
    let decoded = |fraction| progress(Progress { stage: "images", fraction });
    let images = images::read(&buffers, files, &images, &mut { decoded })?;
    let (meshes, notes) = (geometry.meshes, notes.into_lines());
    Ok(Scene { meshes, materials, images, instances, lights, cameras, notes })
}

fn note_what_is_not_drawn(document: &Document, notes: &mut Notes) {
    for name in document.extensions_used.iter().filter(|name| !SUPPORTED_EXTENSIONS.contains(&name.as_str()))
    {
        notes.add("extensionsUsed", format!("{name} is not drawn"));
    }
    if !document.animations.is_empty() {
        notes.add("animation 0", "animations are not played, the scene is drawn at rest");
    }
    if let Some(node) = document.nodes.iter().position(|node| node.skin.is_some()) {
        notes.add(place("node", node, None), "skins are not drawn, the mesh is drawn at rest");
    }
}

fn check_instance_count(document: &Document, nodes: &[PlacedNode]) -> Result<(), Fault> {
    let primitives = |placed: &PlacedNode| {
        let mesh = document.nodes.get(placed.node)?.mesh?;
        Some(document.meshes.get(mesh.value())?.primitives.len())
    };
    let count = nodes.iter().filter_map(primitives).fold(0usize, usize::saturating_add);
    if count > MAX_INSTANCES {
        return Err(fault(
            "nodes",
            format!("{count} instances of primitives (allowed: up to {MAX_INSTANCES})"),
        ));
    }
    Ok(())
}

/// The meshes of the scene, and where each primitive of the file went.
struct Geometry {
    meshes: Vec<Mesh>,
    /// For each mesh of the file: index of the scene's mesh and of its material, for each drawn primitive.
    primitives: Vec<Vec<(usize, usize)>>,
}

impl Geometry {
    /// Reads the meshes that are used by nodes. Primitives without a material get a default one, added
    /// at the end if there is need of it.
    fn read(
        buffers: &Buffers<'_>,
        nodes: &[PlacedNode],
        materials: &mut Vec<Material>,
        notes: &mut Notes,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self, Fault> {
        let document = buffers.document();
        let mut used = vec![false; document.meshes.len()];
        for mesh in nodes.iter().filter_map(|placed| document.nodes.get(placed.node)?.mesh) {
            used.get_mut(mesh.value()).into_iter().for_each(|used| *used = true);
        }
        let default_material = document.materials.len();
        let mut geometry = Self { meshes: Vec::new(), primitives: vec![Vec::new(); document.meshes.len()] };
        let mut reader = Reader::new(buffers, notes);
        let meshes = document.meshes.iter().zip(used).zip(&mut geometry.primitives).enumerate();
        for (i, ((mesh, used), primitives)) in meshes {
            progress(Progress { stage: "meshes", fraction: i as f32 / document.meshes.len() as f32 });
            for (j, primitive) in mesh.primitives.iter().enumerate().filter(|_| used) {
                let material = primitive.material.map_or(default_material, |material| material.value());
                let normal_map = materials.get(material).and_then(|material| material.normal_texture);
                let Some(mesh) = reader.primitive(i, j, normal_map.as_ref())? else { continue };
                if material == materials.len() {
                    materials.push(Material::default());
                }
                primitives.push((geometry.meshes.len(), material));
                geometry.meshes.push(mesh);
            }
        }
        progress(Progress { stage: "meshes", fraction: 1.0 });
        Ok(geometry)
    }

    fn instances(&self, document: &Document, nodes: &[PlacedNode]) -> Result<Vec<Instance>, Fault> {
        let mut instances = Vec::new();
        for placed in nodes {
            let Some(node) = document.nodes.get(placed.node) else { continue };
            let primitives = node.mesh.and_then(|mesh| self.primitives.get(mesh.value()));
            for (mesh, material) in primitives.into_iter().flatten().copied() {
                let name = clean_name(node.name.as_deref());
                let instance = Instance { name, mesh, material, world_from_local: placed.world_from_node };
                self.check_range(&instance, placed.node)?;
                instances.push(instance);
            }
        }
        Ok(instances)
    }

    /// Makes sure that an instance lies where numbers are still good for something.
    fn check_range(&self, instance: &Instance, node: usize) -> Result<(), Fault> {
        let Some(mesh) = self.meshes.get(instance.mesh) else { return Ok(()) };
        let bounds = mesh.bounds.transformed(&instance.world_from_local);
        let reach = bounds.min.abs().max(bounds.max.abs()).max_element();
        if bounds.is_empty() || reach <= MAX_WORLD_M {
            return Ok(());
        }
        let reason =
            format!("its mesh reaches {reach:.3e} m from the origin (allowed: up to {MAX_WORLD_M:e} m)");
        Err(fault(place("node", node, Some(&instance.name)), reason))
    }
}
