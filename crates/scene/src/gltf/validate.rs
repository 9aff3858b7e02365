//! Limits of what is loaded, and the checks of a file's references.

use ::gltf::json;

use super::document::{Document, Head};
use super::fault::{Fault, fault, place};

/// The extensions that are drawn; a file that requires another one is refused.
pub const SUPPORTED_EXTENSIONS: [&str; 5] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// The most bytes that are read for a scene, over all of its files.
pub const MAX_BYTES: u64 = 1 << 31;
/// The most vertices of a scene, over all of its meshes.
pub const MAX_VERTICES: usize = 24_000_000;
/// The most indices of a scene, over all of its meshes.
pub const MAX_INDICES: usize = 100_000_000;
/// The most instances of a scene.
pub const MAX_INSTANCES: usize = 1_000_000;
/// The farthest from the world's origin that anything may be, metres.
pub const MAX_WORLD_M: f64 = 1e15;

/// Checks the version and the required extensions.
pub(super) fn check_head(head: &Head) -> Result<(), Fault> {
    let major = head.asset.version.split_once('.').map(|(major, _)| major);
    if major != Some("2") {
        let reason = format!("version {:?} is not supported (allowed: \"2.0\")", head.asset.version);
        return Err(fault("asset", reason));
    }
    if let Some(least) = head.asset.min_version.as_deref().filter(|version| *version != "2.0") {
        return Err(fault("asset", format!("minVersion {least:?} is not supported (allowed: \"2.0\")")));
    }
    let unknown = |name: &&String| !SUPPORTED_EXTENSIONS.contains(&name.as_str());
    match head.extensions_required.iter().find(unknown) {
        None => Ok(()),
        Some(name) => Err(fault("extensionsRequired", format!("{name:?} is not supported"))),
    }
}

/// Checks that whatever the file refers to by index is there.
pub(super) fn check_references(document: &Document) -> Result<(), Fault> {
    check_buffers(document)?;
    check_meshes(document)?;
    check_nodes(document)?;
    for (i, texture) in document.textures.iter().enumerate() {
        let there = Place { kind: "texture", index: i, name: texture.name.as_deref() };
        // The gltf crate has this value where there is no source.
        if texture.source.value() == u32::MAX as usize {
            return Err(fault(there.text(), "has no image (allowed: PNG or JPEG)"));
        }
        there.check("source", Some(texture.source), document.images.len())?;
        there.check("sampler", texture.sampler, document.samplers.len())?;
    }
    for (i, material) in document.materials.iter().enumerate() {
        let there = Place { kind: "material", index: i, name: material.name.as_deref() };
        let count = document.textures.len();
        let pbr = &material.pbr_metallic_roughness;
        there.check("baseColorTexture", pbr.base_color_texture.as_ref().map(|t| t.index), count)?;
        let texture = pbr.metallic_roughness_texture.as_ref().map(|t| t.index);
        there.check("metallicRoughnessTexture", texture, count)?;
        there.check("normalTexture", material.normal_texture.as_ref().map(|t| t.index), count)?;
        there.check("occlusionTexture", material.occlusion_texture.as_ref().map(|t| t.index), count)?;
        there.check("emissiveTexture", material.emissive_texture.as_ref().map(|t| t.index), count)?;
    }
    Ok(())
}

fn check_buffers(document: &Document) -> Result<(), Fault> {
    let views = document.buffer_views.len();
    for (i, view) in document.buffer_views.iter().enumerate() {
        let there = Place { kind: "bufferView", index: i, name: view.name.as_deref() };
        there.check("buffer", Some(view.buffer), document.buffers.len())?;
    }
    for (i, accessor) in document.accessors.iter().enumerate() {
        let there = Place { kind: "accessor", index: i, name: accessor.name.as_deref() };
        there.check("bufferView", accessor.buffer_view, views)?;
        if let Some(sparse) = &accessor.sparse {
            there.check("sparse indices bufferView", Some(sparse.indices.buffer_view), views)?;
            there.check("sparse values bufferView", Some(sparse.values.buffer_view), views)?;
        }
    }
    for (i, image) in document.images.iter().enumerate() {
        let there = Place { kind: "image", index: i, name: image.name.as_deref() };
        there.check("bufferView", image.buffer_view, views)?;
    }
    Ok(())
}

fn check_meshes(document: &Document) -> Result<(), Fault> {
    for (i, mesh) in document.meshes.iter().enumerate() {
        for (j, primitive) in mesh.primitives.iter().enumerate() {
            let count = document.accessors.len();
            let what = |field: &str| format!("primitive {j} {field}");
            let there = Place { kind: "mesh", index: i, name: mesh.name.as_deref() };
            there.check(&what("indices"), primitive.indices, count)?;
            there.check(&what("material"), primitive.material, document.materials.len())?;
            for accessor in primitive.attributes.values() {
                there.check(&what("attribute"), Some(*accessor), count)?;
            }
        }
    }
    Ok(())
}

fn check_nodes(document: &Document) -> Result<(), Fault> {
    for (i, node) in document.nodes.iter().enumerate() {
        let there = Place { kind: "node", index: i, name: node.name.as_deref() };
        there.check("mesh", node.mesh, document.meshes.len())?;
        there.check("camera", node.camera, document.cameras.len())?;
        let light = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()).map(|l| l.light);
        there.check("light", light, document.lights().len())?;
        for child in node.children.iter().flatten() {
            there.check("child", Some(*child), document.nodes.len())?;
        }
    }
    for (i, scene) in document.scenes.iter().enumerate() {
        let there = Place { kind: "scene", index: i, name: None };
        for node in &scene.nodes {
            there.check("node", Some(*node), document.nodes.len())?;
        }
    }
    Ok(())
}

/// The object whose references are checked.
struct Place<'a> {
    kind: &'a str,
    index: usize,
    name: Option<&'a str>,
}

impl Place<'_> {
    fn text(&self) -> String {
        place(self.kind, self.index, self.name)
    }

    /// Checks one reference of the object.
    fn check<T>(&self, field: &str, index: Option<json::Index<T>>, count: usize) -> Result<(), Fault> {
        match index {
            Some(index) if index.value() >= count => {
                Err(fault(self.text(), out_of_range(field, index.value(), count)))
            }
            _ => Ok(()),
        }
    }
}

/// Describes an index that points at nothing.
fn out_of_range(field: &str, index: usize, count: usize) -> String {
    match count.checked_sub(1) {
        None => format!("{field} {index} does not exist (there are none)"),
        Some(last) => format!("{field} {index} does not exist (allowed: 0 to {last})"),
    }
}
