//! The JSON of a glTF file, in the `gltf` crate's types.
//!
//! The lists are our own: what is not drawn (animations, skins) is only counted, so that a fault there
//! does not keep the rest from being drawn.

use ::gltf::json;
use json::Index;
use json::extensions::scene::khr_lights_punctual::Light;
use serde::Deserialize;
use serde::de::IgnoredAny;

use super::fault::{Fault, fault};
use super::validate;

/// The lists of a glTF file.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
pub(super) struct Document {
    #[serde(default)]
    pub(super) accessors: Vec<json::Accessor>,
    #[serde(default)]
    pub(super) animations: Vec<IgnoredAny>,
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
    pub(super) textures: Vec<json::Texture>,
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
}

#[derive(Debug, Deserialize)]
#[serde(expecting = "an object with lights")]
struct Lights {
    lights: Vec<Light>,
}

/// What is read before all else, so that a file of another version or with unknown extensions is
/// refused for this reason and not for what follows from it.
#[derive(Debug, Deserialize)]
#[serde(rename_all = "camelCase", expecting = "a glTF object")]
pub(super) struct Head {
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

impl Document {
    /// Reads the JSON of a file and checks every reference in it.
    ///
    /// # Errors
    /// Names the first thing that is wrong, with its place.
    pub(super) fn parse(text: &[u8]) -> Result<Self, Fault> {
        let wrong = |error: json::Error| fault("JSON", error);
        let head: Head = serde_json::from_slice(text).map_err(wrong)?;
        validate::check_head(&head)?;
        let document: Self = serde_json::from_slice(text).map_err(wrong)?;
        validate::check_references(&document)?;
        Ok(document)
    }

    /// Returns the lights of the file.
    pub(super) fn lights(&self) -> &[Light] {
        self.extensions.lights_punctual.as_ref().map_or(&[], |lights| &lights.lights)
    }
}
