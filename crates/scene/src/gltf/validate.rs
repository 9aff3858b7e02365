//! Limits of an import, and checks of a file's references.

use ::gltf::json;

use super::document::{Document, Header};
use super::error::{ImportError, describe};

/// The supported extensions; requiring another one is an error.
pub const SUPPORTED_EXTENSIONS: [&str; 16] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_texture_basisu",
    "KHR_texture_transform",
];

/// The maximum number of bytes read for a scene, over all of its files.
pub const MAX_BYTES: u64 = 1 << 31;
/// The maximum number of vertices of a scene, over all of its meshes.
pub const MAX_VERTICES: usize = 24_000_000;
/// The maximum number of indices of a scene, over all of its meshes.
pub const MAX_INDICES: usize = 100_000_000;
/// The maximum number of nodes of a scene, with their copies, and of its instances. [`Scene::insert_instance`] allows more: as many as
/// the buffers of the device.
///
/// [`Scene::insert_instance`]: crate::Scene::insert_instance
pub const MAX_INSTANCES: usize = 1 << 21;
/// The maximum number of joints of a skin.
pub const MAX_JOINTS: usize = 1 << 16;
/// The maximum number of times and values of keyframes of a scene, over all of its animations.
pub const MAX_KEYFRAME_VALUES: usize = 1 << 26;
/// The maximum number of morph weights of a scene, over all of its nodes.
pub const MAX_MORPH_WEIGHTS: usize = 1 << 22;
/// The maximum distance from the world's origin, metres.
pub const MAX_WORLD_M: f64 = crate::origin::MAX_WORLD_M;

/// Checks the version and the required extensions.
pub(super) fn check_header(header: &Header) -> Result<(), ImportError> {
    let major = header.asset.version.split_once('.').map(|(major, _)| major);
    if major != Some("2") {
        let reason = format!("version {:?} is not supported (allowed: \"2.0\")", header.asset.version);
        return Err(ImportError::new("asset", reason));
    }
    if let Some(min) = header.asset.min_version.as_deref().filter(|version| *version != "2.0") {
        return Err(ImportError::new(
            "asset",
            format!("minVersion {min:?} is not supported (allowed: \"2.0\")"),
        ));
    }
    check_required_extensions(&header.extensions_required)
}

fn check_required_extensions(required: &[String]) -> Result<(), ImportError> {
    let unsupported = required.iter().filter(|name| !SUPPORTED_EXTENSIONS.contains(&name.as_str()));
    let names: Vec<_> = unsupported.map(|name| format!("{name:?}")).collect();
    let Some(first) = names.first() else { return Ok(()) };
    let (names, verb) = if names.len() > 1 { (names.join(", "), "are") } else { (first.clone(), "is") };
    let reason = format!(
        "{names} {verb} not supported (to convert the file, import it in Blender and export it as glTF)"
    );
    Err(ImportError::new("extensionsRequired", reason))
}

/// Checks that everything that the file refers to by index exists.
pub(super) fn check_references(document: &Document) -> Result<(), ImportError> {
    check_buffers(document)?;
    check_meshes(document)?;
    check_nodes(document)?;
    check_skins(document)?;
    check_animations(document)
}

fn check_buffers(document: &Document) -> Result<(), ImportError> {
    let views = document.buffer_views.len();
    for (i, view) in document.buffer_views.iter().enumerate() {
        let object = Object { kind: "bufferView", index: i, name: view.name.as_deref() };
        object.check("buffer", Some(view.buffer), document.buffers.len())?;
    }
    for (i, accessor) in document.accessors.iter().enumerate() {
        let object = Object { kind: "accessor", index: i, name: accessor.name.as_deref() };
        object.check("bufferView", accessor.buffer_view, views)?;
        if let Some(sparse) = &accessor.sparse {
            object.check("sparse indices bufferView", Some(sparse.indices.buffer_view), views)?;
            object.check("sparse values bufferView", Some(sparse.values.buffer_view), views)?;
        }
    }
    for (i, image) in document.images.iter().enumerate() {
        let object = Object { kind: "image", index: i, name: image.name.as_deref() };
        object.check("bufferView", image.buffer_view, views)?;
    }
    Ok(())
}

fn check_meshes(document: &Document) -> Result<(), ImportError> {
    for (i, mesh) in document.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let count = document.accessors.len();
            let field = |field: &str| format!("primitive {j} {field}");
            let object = Object { kind: "mesh", index: i, name: mesh.name.as_deref() };
            object.check(&field("indices"), primitive.indices, count)?;
            object.check(&field("material"), primitive.material, document.materials.len())?;
            let variants = primitive.extensions.as_ref().and_then(|e| e.khr_materials_variants.as_ref());
            for mapping in variants.iter().flat_map(|variants| &variants.mappings) {
                let material = json::Index::<json::Material>::new(mapping.material);
                object.check(&field("material of a variant"), Some(material), document.materials.len())?;
            }
            for accessor in primitive.attributes.values() {
                object.check(&field("attribute"), Some(*accessor), count)?;
            }
            for target in primitive.targets.iter().flatten() {
                for accessor in [target.positions, target.normals, target.tangents] {
                    object.check(&field("target"), accessor, count)?;
                }
            }
        }
    }
    Ok(())
}

fn check_nodes(document: &Document) -> Result<(), ImportError> {
    for (i, node) in document.nodes.iter().enumerate() {
        let object = Object { kind: "node", index: i, name: node.name.as_deref() };
        object.check("mesh", node.mesh, document.meshes.len())?;
        object.check("camera", node.camera, document.cameras.len())?;
        object.check("skin", node.skin, document.skins.len())?;
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map(|l| l.light);
        object.check("light", light, document.lights().len())?;
        for child in node.children.iter().flatten() {
            object.check("child", Some(*child), document.nodes.len())?;
        }
    }
    for (i, scene) in document.scenes.iter().enumerate() {
        let object = Object { kind: "scene", index: i, name: None };
        for node in &scene.nodes {
            object.check("node", Some(*node), document.nodes.len())?;
        }
    }
    Ok(())
}

fn check_skins(document: &Document) -> Result<(), ImportError> {
    for (i, skin) in document.skins.iter().enumerate() {
        let object = Object { kind: "skin", index: i, name: skin.name.as_deref() };
        object.check("inverseBindMatrices", skin.inverse_bind_matrices, document.accessors.len())?;
        for joint in &skin.joints {
            object.check("joint", Some(*joint), document.nodes.len())?;
        }
    }
    Ok(())
}

fn check_animations(document: &Document) -> Result<(), ImportError> {
    for (i, animation) in document.animations.iter().enumerate() {
        let object = Object { kind: "animation", index: i, name: animation.name.as_deref() };
        for sampler in &animation.samplers {
            object.check("input", Some(sampler.input), document.accessors.len())?;
            object.check("output", Some(sampler.output), document.accessors.len())?;
        }
        for channel in &animation.channels {
            object.check("sampler", Some(channel.sampler), animation.samplers.len())?;
            object.check("target node", channel.target.node, document.nodes.len())?;
        }
    }
    Ok(())
}

/// The object whose references are checked.
struct Object<'a> {
    kind: &'a str,
    index: usize,
    name: Option<&'a str>,
}

impl Object<'_> {
    fn describe(&self) -> String {
        describe(self.kind, self.index, self.name)
    }

    /// Checks one reference of the object.
    fn check<T>(&self, field: &str, index: Option<json::Index<T>>, count: usize) -> Result<(), ImportError> {
        match index {
            Some(index) if index.value() >= count => {
                Err(ImportError::new(self.describe(), out_of_range(field, index.value(), count)))
            }
            _ => Ok(()),
        }
    }
}

/// Describes an index of something that does not exist.
fn out_of_range(field: &str, index: usize, count: usize) -> String {
    match count.checked_sub(1) {
        None => format!("{field} {index} does not exist (there are none)"),
        Some(last) => format!("{field} {index} does not exist (allowed: 0 to {last})"),
    }
}
