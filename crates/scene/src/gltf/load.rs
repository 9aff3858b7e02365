//! The steps of an import.

use std::path::Path;

use super::buffers::Buffers;
use super::document::{Document, Header};
use super::error::{ImportError, clean_name, describe};
use super::files::{Files, read_file};
use super::materials::FileMaterial;
use super::mesh::Reader;
use super::nodes::{self, Role, SceneNode};
use super::notes::Notes;
use super::skins::Skins;
use super::validate::{
    MAX_BYTES, MAX_INSTANCES, MAX_VERTICES, MAX_WORLD_M, SUPPORTED_EXTENSIONS, check_header, check_references,
};
use super::{
    animations, container, conversions, extras, hierarchy, images, instancing, materials, uri, variants,
};
use crate::error::Error;
use crate::keys::{InstanceKey, MaterialKey};
use crate::material::{Image, TextureRef};
use crate::mesh::Mesh;
use crate::scene::{Attachment, EditError, Hierarchy, Instance, ObjectShadows, Scene};

/// The progress of loading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// The current step: "reading", "meshes", "images".
    pub stage: &'static str,
    /// The completed fraction of the step, 0 to 1.
    pub fraction: f32,
}

/// Loads a glTF or GLB file.
///
/// Files that it refers to are read only from its directory.
///
/// # Errors
/// The message is one line: the file, the location in it, and what is wrong there.
///
/// ```
/// let directory = tempfile::tempdir()?;
/// let file = directory.path().join("empty.gltf");
/// std::fs::write(&file, r#"{"asset": {"version": "2.0"}, "scenes": [{}]}"#)?;
/// let scene = shadowgraph_scene::gltf::load(&file)?;
/// assert!(scene.bounds().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load(path: &Path) -> Result<Scene, Error> {
    load_with(path, &LoadOptions::default(), &mut |_| {})
}

/// What is loaded of a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LoadOptions {
    /// The name of the variant of KHR_materials_variants; `None` for the default materials.
    pub variant: Option<String>,
}

/// Loads a glTF or GLB file with options, and reports its progress, always on the calling thread.
///
/// # Errors
/// The same as [`load`]; the file has no variant with the name.
pub fn load_with(
    path: &Path,
    options: &LoadOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<Scene, Error> {
    let unreadable = |source| Error::Read { file: path.to_owned(), source };
    progress(Progress { stage: "reading", fraction: 0.0 });
    let bytes = read_file(path, MAX_BYTES).map_err(unreadable)?;
    let files =
        Files::in_directory_of(path, MAX_BYTES.saturating_sub(bytes.len() as u64)).map_err(unreadable)?;
    progress(Progress { stage: "reading", fraction: 1.0 });
    import(&bytes, &files, options, progress).map_err(|error| invalid(path, error))
}

/// Loads a glTF or GLB file in memory, such as one that was dropped on a page. `name` is for errors; `files` are those that
/// it may refer to: their paths relative to it, with `/`, and their contents.
///
/// # Errors
/// The same as [`load_with`].
///
/// ```
/// use shadowgraph_scene::gltf::{LoadOptions, load_bytes};
/// let text = br#"{"asset": {"version": "2.0"}, "scenes": [{}]}"#;
/// let scene = load_bytes("empty.gltf", text, &[], &LoadOptions::default(), &mut |_| {})?;
/// assert!(scene.bounds().is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn load_bytes(
    name: &str,
    bytes: &[u8],
    files: &[(String, Vec<u8>)],
    options: &LoadOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<Scene, Error> {
    import(bytes, &Files::in_memory(files), options, progress)
        .map_err(|error| invalid(Path::new(name), error))
}

/// Returns the paths of the files that a glTF or GLB file in memory refers to, relative to it and with `/`: what [`load_bytes`] needs besides it.
/// `name` is for errors.
///
/// ```
/// use shadowgraph_scene::gltf::referenced_files;
/// let text = br#"{"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": "a%20b.bin"}]}"#;
/// assert_eq!(referenced_files("scene.gltf", text)?, ["a b.bin"]);
/// # Ok::<(), shadowgraph_scene::Error>(())
/// ```
///
/// # Errors
/// For a file that is no glTF, and for a path that leads out of the file's directory.
pub fn referenced_files(name: &str, bytes: &[u8]) -> Result<Vec<String>, Error> {
    references(bytes).map_err(|error| invalid(Path::new(name), error))
}

fn references(bytes: &[u8]) -> Result<Vec<String>, ImportError> {
    let document = Document::from_json(container::split(bytes)?.json)?;
    let buffers = document.buffers.iter().map(|buffer| ("buffers", &buffer.uri));
    let images = document.images.iter().map(|image| ("images", &image.uri));
    let mut paths: Vec<String> = Vec::new();
    for (location, uri) in buffers.chain(images) {
        let Some(uri) = uri.as_deref().filter(|uri| uri::data(uri).is_none()) else { continue };
        let path = uri::relative_path(uri).map_err(|reason| ImportError::new(location, reason))?;
        let names: Vec<_> = path.iter().map(|name| name.to_string_lossy()).collect();
        let path = names.join("/");
        if !paths.contains(&path) {
            paths.push(path);
        }
    }
    Ok(paths)
}

fn invalid(file: &Path, ImportError { location, reason }: ImportError) -> Error {
    Error::Invalid { file: file.to_owned(), location, reason }
}

fn import(
    bytes: &[u8],
    files: &Files<'_>,
    options: &LoadOptions,
    progress: &mut dyn FnMut(Progress),
) -> Result<Scene, ImportError> {
    let chunks = container::split(bytes)?;
    check_header(&Header::from_json(chunks.json)?)?;
    let document = Document::from_json(chunks.json)?;
    check_references(&document)?;
    let mut notes = Notes::default();
    note_unsupported_extensions(&document, &mut notes);
    let variant = variants::find(&document, options.variant.as_deref(), &mut notes)?;
    let mut nodes = nodes::walk(&document, &mut notes)?;
    let lights = nodes::lights(&document, &nodes, &mut notes)?;
    let cameras = nodes::cameras(&document, &nodes)?;
    let materials::Materials { mut materials, images } = materials::read(&document, &mut notes)?;
    let buffers = Buffers::read(&document, chunks.bin, files)?;
    instancing::add_copies(&buffers, &mut nodes)?;
    check_instance_count(&document, &nodes)?;
    let skins = Skins::read(&buffers, &nodes)?;
    let hierarchy_nodes = hierarchy::nodes(&document, &nodes, &skins)?;
    let animations = animations::Reader::new(&buffers, &nodes, &hierarchy_nodes, &mut notes).animations()?;
    let geometry = Geometry::read(&buffers, &nodes, variant, &mut materials, &mut notes, progress)?;
    geometry.check_range(&document, &nodes)?;
    geometry.check_deformed(&document, &nodes, &skins)?;
    let decoded = |fraction| progress(Progress { stage: "images", fraction });
    let images = images::read(&buffers, files, &images, &mut { decoded });
    let mut images: Vec<_> = images.into_iter().map(|image| usable(image, &mut notes)).collect();
    let mut converted = conversions::Images::new(&mut images);
    materials.iter_mut().for_each(|material| converted.convert(material, &mut notes));
    let shadows = extras::of_nodes(&document, &mut notes);
    let mut scene = Scene::default();
    scene.notes = notes.into_lines();
    let inserted = insert_materials(&mut scene, images, materials)
        .and_then(|materials| geometry.insert(&mut scene, (&document, &shadows), &nodes, &materials));
    // Everything has been checked with its location before.
    let instances = inserted.map_err(|error| ImportError::new("scene", error.to_string()))?;
    let lights =
        lights.into_iter().map(|(node, light)| Attachment { node, object: scene.insert_light(light) });
    let lights = lights.collect();
    let (camera_nodes, all_cameras): (Vec<usize>, _) = cameras.into_iter().unzip();
    let cameras = (0..).zip(camera_nodes).map(|(object, node)| Attachment { node, object }).collect();
    scene.cameras = all_cameras;
    let (nodes, skins) = (hierarchy_nodes, skins.skins);
    scene.hierarchy = Hierarchy { nodes, skins, animations, instances, lights, cameras };
    scene.deform_at_rest().map_err(|error| ImportError::new("scene", error.to_string()))?;
    Ok(scene)
}

/// Returns an image that could be read; otherwise adds a note.
fn usable(image: Result<Image, ImportError>, notes: &mut Notes) -> Option<Image> {
    image.inspect_err(|error| notes.add(&error.location, format!("{}; it is not drawn", error.reason))).ok()
}

/// Inserts the images and the materials, and returns the keys of the materials. Textures without an image are left out.
fn insert_materials(
    scene: &mut Scene,
    images: Vec<Option<Image>>,
    materials: Vec<FileMaterial>,
) -> Result<Vec<MaterialKey>, EditError> {
    let insert_image = |image: Option<Image>| image.map(|image| scene.insert_image(image)).transpose();
    let images: Vec<_> = images.into_iter().map(insert_image).collect::<Result<_, _>>()?;
    let insert = |FileMaterial { mut material, images: used, .. }: FileMaterial| {
        for (texture, used) in material.textures_mut().into_iter().zip(used) {
            let image = used.and_then(|index| images.get(index).copied().flatten());
            *texture = texture.zip(image).map(|(texture, image)| TextureRef { image, ..texture });
        }
        scene.insert_material(material)
    };
    materials.into_iter().map(insert).collect()
}

fn note_unsupported_extensions(document: &Document, notes: &mut Notes) {
    for name in document.extensions_used.iter().filter(|name| !SUPPORTED_EXTENSIONS.contains(&name.as_str()))
    {
        notes.add("extensionsUsed", format!("{name} is not drawn"));
    }
}

fn check_instance_count(document: &Document, nodes: &[SceneNode]) -> Result<(), ImportError> {
    let primitives = |scene_node: &SceneNode| {
        let mesh = document.nodes.get(scene_node.node)?.mesh?;
        Some(document.meshes.get(mesh.value())?.primitives.len())
    };
    let drawing = nodes.iter().filter(|node| node.role != Role::Instanced);
    let count = drawing.filter_map(primitives).fold(0usize, usize::saturating_add);
    if count > MAX_INSTANCES {
        return Err(ImportError::new(
            "nodes",
            format!("{count} instances of primitives (allowed: up to {MAX_INSTANCES})"),
        ));
    }
    Ok(())
}

/// The meshes of the scene, and the mesh and material of each primitive of the file.
struct Geometry {
    meshes: Vec<Mesh>,
    /// Index of the scene's mesh and of its material, for each drawn primitive of each mesh of the file.
    primitives: Vec<Vec<(usize, usize)>>,
}

impl Geometry {
    /// Reads the meshes that nodes use. Primitives without a material get a default one, which is appended if it is
    /// needed.
    fn read(
        buffers: &Buffers<'_>,
        nodes: &[SceneNode],
        variant: Option<u32>,
        materials: &mut Vec<FileMaterial>,
        notes: &mut Notes,
        progress: &mut dyn FnMut(Progress),
    ) -> Result<Self, ImportError> {
        let document = buffers.document();
        let mut used = vec![false; document.meshes.len()];
        for mesh in nodes.iter().filter_map(|scene_node| document.nodes.get(scene_node.node)?.mesh) {
            used.get_mut(mesh.value()).into_iter().for_each(|used| *used = true);
        }
        let default_material = document.materials.len();
        let mut geometry = Self { meshes: Vec::new(), primitives: vec![Vec::new(); document.meshes.len()] };
        let mut reader = Reader::new(buffers, notes);
        let meshes = document.meshes.iter().zip(used).zip(&mut geometry.primitives).enumerate();
        for (i, ((mesh, used), primitives)) in meshes {
            progress(Progress { stage: "meshes", fraction: i as f32 / document.meshes.len() as f32 });
            for (j, primitive) in mesh.primitives.iter().enumerate().filter(|_| used) {
                let material = variants::material(primitive, variant).unwrap_or(default_material);
                let normal_map =
                    materials.get(material).and_then(|material| material.material.normal_texture);
                let Some(mesh) = reader.primitive(i, j, normal_map.as_ref())? else { continue };
                if material == materials.len() {
                    materials.push(FileMaterial::default());
                }
                primitives.push((geometry.meshes.len(), material));
                geometry.meshes.push(mesh);
            }
        }
        progress(Progress { stage: "meshes", fraction: 1.0 });
        Ok(geometry)
    }

    /// Returns the mesh and the material of each drawn primitive, with the node that draws it and the index of the node.
    fn drawn<'a>(
        &'a self,
        document: &'a Document,
        nodes: &'a [SceneNode],
    ) -> impl Iterator<Item = (usize, &'a SceneNode, String, usize, usize)> {
        let nodes = nodes.iter().enumerate().filter(|(_, node)| node.role != Role::Instanced);
        nodes.flat_map(move |(number, scene_node)| {
            let node = document.nodes.get(scene_node.node);
            let primitives = node.and_then(|node| self.primitives.get(node.mesh?.value()));
            let name = clean_name(node.and_then(|node| node.name.as_deref()));
            let drawn = primitives.into_iter().flatten();
            drawn.map(move |&(mesh, material)| (number, scene_node, name.clone(), mesh, material))
        })
    }

    /// Checks that every instance lies within the supported range.
    fn check_range(&self, document: &Document, nodes: &[SceneNode]) -> Result<(), ImportError> {
        for (_, scene_node, name, mesh, _) in self.drawn(document, nodes) {
            let Some(mesh) = self.meshes.get(mesh) else { continue };
            let bounds = mesh.bounds.transformed(&scene_node.world_from_node);
            let extent_m = bounds.min.abs().max(bounds.max.abs()).max_element();
            if !bounds.is_empty() && extent_m > MAX_WORLD_M {
                let reason = format!(
                    "its mesh extends to {extent_m:.3e} m from the origin (allowed: up to {MAX_WORLD_M:e} m)"
                );
                return Err(ImportError::new(describe("node", scene_node.node, Some(&name)), reason));
            }
        }
        Ok(())
    }

    /// Checks the number of deformed vertices, and that the skin of each node has every joint that its meshes need.
    fn check_deformed(
        &self,
        document: &Document,
        nodes: &[SceneNode],
        skins: &Skins,
    ) -> Result<(), ImportError> {
        let mut vertices_left = MAX_VERTICES;
        for (_, scene_node, name, mesh, _) in self.drawn(document, nodes) {
            let Some(mesh) = self.meshes.get(mesh) else { continue };
            let skin = document.nodes.get(scene_node.node).and_then(|node| skins.get(node.skin?.value()));
            if (mesh.skin.is_some() && skin.is_some()) || !mesh.morph_targets.is_empty() {
                vertices_left = vertices_left.checked_sub(mesh.vertices.len()).ok_or_else(|| {
                    ImportError::new(
                        "nodes",
                        format!("their skins and morph targets deform over {MAX_VERTICES} vertices"),
                    )
                })?;
            }
            let Some((weights, skin)) = mesh.skin.as_ref().zip(skin) else { continue };
            let (needed, count) = (weights.joint_bounds().len(), skin.joints.len());
            if needed > count {
                let reason = format!("its mesh needs joint {} of a skin with {count} joints", needed - 1);
                return Err(ImportError::new(describe("node", scene_node.node, Some(&name)), reason));
            }
        }
        Ok(())
    }

    /// Inserts the meshes and their instances, and returns the instances with their nodes.
    fn insert(
        mut self,
        scene: &mut Scene,
        (document, shadows): (&Document, &[ObjectShadows]),
        nodes: &[SceneNode],
        materials: &[MaterialKey],
    ) -> Result<Vec<Attachment<InstanceKey>>, EditError> {
        let meshes: Vec<_> =
            std::mem::take(&mut self.meshes).into_iter().map(|mesh| scene.insert_mesh(mesh)).collect();
        let mut attachments = Vec::new();
        for (node, scene_node, name, mesh, material) in self.drawn(document, nodes) {
            if let (Some(&mesh), Some(&material)) = (meshes.get(mesh), materials.get(material)) {
                let instance = Instance::new(mesh, material, scene_node.world_from_node).with_name(name);
                let instance = extras::apply_to_instance(shadows.get(scene_node.node), instance);
                attachments.push(Attachment { node, object: scene.insert_instance(instance)? });
            }
        }
        Ok(attachments)
    }
}
