//! The JSON of a glTF file, in the `gltf` crate's types.
//!
//! The top-level object is our own type, and so are animations, so that channels of extensions do not prevent the rest from being
//! drawn.

use ::gltf::json;
use json::Index;
use json::extensions::scene::khr_lights_punctual::Light;
use serde::Deserialize;

use super::error::ImportError;

/// The top-level object of a glTF file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
pub(super) struct Document {
    #[serde(default)]
    pub(super) accessors: Vec<json::Accessor>,
    #[serde(default)]
    pub(super) animations: Vec<Animation>,
    #[serde(default)]
    pub(super) buffers: Vec<json::Buffer>,
    #[serde(default)]
    pub(super) buffer_views: Vec<json::buffer::View>,
    #[serde(default)]
    pub(super) cameras: Vec<json::Camera>,
    #[serde(default)]
    pub(super) extensions: Extensions,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) images: Vec<json::Image>,
    #[serde(default)]
    pub(super) materials: Vec<json::Material>,
    #[serde(default)]
    pub(super) meshes: Vec<json::Mesh>,
    #[serde(default)]
    pub(super) nodes: Vec<json::Node>,
    #[serde(default)]
    pub(super) samplers: Vec<json::texture::Sampler>,
    pub(super) scene: Option<u64>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) skins: Vec<json::Skin>,
    #[serde(default)]
    pub(super) textures: Vec<json::Texture>,
}

/// Properties of nodes over time.
#[derive(Debug, Deserialize)]
#[serde(expecting = "an animation object")]
pub(super) struct Animation {
    pub(super) name: Option<String>,
    #[serde(default)]
    pub(super) channels: Vec<Channel>,
    #[serde(default)]
    pub(super) samplers: Vec<Sampler>,
}

/// A sampler and the property that it animates.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a channel object")]
pub(super) struct Channel {
    pub(super) sampler: Index<Sampler>,
    pub(super) target: Target,
}

/// The animated property.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a target object")]
pub(super) struct Target {
    /// Extensions may animate other objects.
    pub(super) node: Option<Index<json::Node>>,
    pub(super) path: String,
}

/// The times and values of keyframes.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a sampler object")]
pub(super) struct Sampler {
    pub(super) input: Index<json::Accessor>,
    pub(super) interpolation: Option<String>,
    pub(super) output: Index<json::Accessor>,
}

/// The root nodes of a scene.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a scene object")]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) nodes: Vec<Index<json::Node>>,
}

/// The extensions of the whole file that are drawn.
#[derive(Debug, Default, Deserialize)]
#[serde(expecting = "an object of extensions")]
pub(super) struct Extensions {
    #[serde(default, rename = "KHR_lights_punctual")]
    lights_punctual: Option<Lights>,
    #[serde(default, rename = "KHR_materials_variants")]
    materials_variants: Option<Variants>,
}

#[derive(Debug, Deserialize)]
#[serde(expecting = "an object with variants")]
struct Variants {
    variants: Vec<Variant>,
}

/// A choice of materials for the whole file.
#[derive(Debug, Deserialize)]
#[serde(expecting = "a variant object")]
pub(super) struct Variant {
    pub(super) name: String,
}

#[derive(Debug, Deserialize)]
#[serde(expecting = "an object with lights")]
struct Lights {
    lights: Vec<Light>,
}

/// The properties that are read first, so that the error for a file of another version or with unknown extensions names
/// this reason and none of its consequences.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
pub(super) struct Header {
    pub(super) asset: Asset,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
}

/// The versions of a file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "an asset object")]
pub(super) struct Asset {
    pub(super) version: String,
    pub(super) min_version: Option<String>,
}

impl Header {
    /// Reads the header from the JSON of a file.
    ///
    /// # Errors
    /// The text is not JSON, or a value in it has the wrong type.
    pub(super) fn from_json(text: &[u8]) -> Result<Self, ImportError> {
        serde_json::from_slice(text).map_err(|error| ImportError::new("JSON", error))
    }
}

impl Document {
    /// Reads the JSON of a file, without checking its references.
    ///
    /// # Errors
    /// The text is not JSON, or a value in it has the wrong type.
    pub(super) fn from_json(text: &[u8]) -> Result<Self, ImportError> {
        serde_json::from_slice(text).map_err(|error| ImportError::new("JSON", error))
    }

    /// Returns the variants of the materials.
    pub(super) fn variants(&self) -> &[Variant] {
        self.extensions.materials_variants.as_ref().map_or(&[], |variants| &variants.variants)
    }

    /// Returns the lights of the file.
    pub(super) fn lights(&self) -> &[Light] {
        self.extensions.lights_punctual.as_ref().map_or(&[], |lights| &lights.lights)
    }
}
