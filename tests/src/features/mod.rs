//! A glTF file for each feature of files that importers of other programs write: the same vase on a floor, under a sun.
#![allow(clippy::unwrap_used, reason = "tests")]

mod compressed;
mod damage;
mod images;
mod instances;
mod materials;
mod model;

pub use damage::damaged;

use crate::gltf_file::File;

/// A feature of files.
#[derive(Clone, Copy)]
pub struct Feature {
    /// The name of the file.
    pub name: &'static str,
    /// The extension, or what is special.
    pub extension: &'static str,
    /// What is drawn.
    pub drawn: &'static str,
    /// Creates the file.
    pub file: fn() -> File,
    /// Whether the image is that of the file without features.
    pub equals_plain: bool,
}

impl std::fmt::Debug for Feature {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// The file without features.
pub const PLAIN: Feature = Feature {
    name: "plain",
    extension: "none",
    drawn: "a textured vase on a floor",
    file: model::plain,
    equals_plain: true,
};

const fn same(
    name: &'static str,
    extension: &'static str,
    drawn: &'static str,
    file: fn() -> File,
) -> Feature {
    Feature { name, extension, drawn, file, equals_plain: true }
}

const fn other(
    name: &'static str,
    extension: &'static str,
    drawn: &'static str,
    file: fn() -> File,
) -> Feature {
    Feature { equals_plain: false, ..same(name, extension, drawn, file) }
}

/// All features.
pub const FEATURES: [Feature; 25] = [
    same("draco", "KHR_draco_mesh_compression", "edgebreaker connectivity", compressed::draco_edgebreaker),
    same(
        "draco_sequential",
        "KHR_draco_mesh_compression",
        "sequential connectivity",
        compressed::draco_sequential,
    ),
    same(
        "meshopt",
        "EXT_meshopt_compression",
        "attributes, filtered normals, triangles",
        compressed::meshopt,
    ),
    same("meshopt_1", "KHR_meshopt_compression", "version 1 of the codec", compressed::meshopt_1),
    same("quantized", "KHR_mesh_quantization", "integer attributes", compressed::quantized),
    same("webp", "EXT_texture_webp", "a WebP image", images::webp),
    same("ktx2_uastc", "KHR_texture_basisu", "a KTX2 image of UASTC", images::uastc),
    same("ktx2_etc1s", "KHR_texture_basisu", "a KTX2 image of ETC1S", images::etc1s),
    other("no_image", "none", "a missing image: a warning and the colour of the factor", images::missing),
    other(
        "no_source",
        "none",
        "a texture without image: a warning and the colour of the factor",
        images::no_source,
    ),
    other("instances", "EXT_mesh_gpu_instancing", "copies of the vase", instances::instances),
    other(
        "spot",
        "KHR_lights_punctual",
        "a spot light whose inner cone is larger than the outer one",
        instances::spot,
    ),
    same("weights", "none", "a morph target at the weights of its mesh", instances::weights),
    same("skin", "none", "a skin posed as its joints stand", instances::skin),
    other(
        "specular_glossiness",
        "KHR_materials_pbrSpecularGlossiness",
        "factors",
        materials::specular_glossiness,
    ),
    other(
        "specular_glossiness_map",
        "KHR_materials_pbrSpecularGlossiness",
        "a texture: gold rings on clay",
        materials::specular_glossiness_map,
    ),
    other("variants", "KHR_materials_variants", "the default, or \"blue\" and \"bare\"", materials::variants),
    other("glass", "KHR_materials_transmission", "clear glass with a light shadow", materials::glass),
    other(
        "stained_glass",
        "KHR_materials_volume, KHR_materials_ior",
        "glass with a coloured shadow",
        materials::stained_glass,
    ),
    other("label", "KHR_materials_transmission", "glass with opaque rings", materials::label),
    other("vertex_colors", "none", "vertex colours in 16 bits, dark without bands", materials::vertex_colors),
    other(
        "caster_modes",
        "extras",
        "a shadow clipped at another alpha than the vase",
        materials::caster_modes,
    ),
    other("shadow_only", "extras", "a second vase of which only the shadow is drawn", instances::shadow_only),
    other("clearcoat", "KHR_materials_clearcoat", "a note: drawn without", materials::clearcoat),
    other("points", "none", "a note: points are left out", instances::points),
];
