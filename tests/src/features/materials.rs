//! Materials of extensions, and vertex colours.

use image::RgbaImage;
use serde_json::{Value, json};

use super::model::{plain, png, rings, with_primitive};
use crate::gltf_file::File;

/// The plain file with another material of the vase, and the extensions of it.
fn with_material(material: Value, extensions: &[&str]) -> File {
    let mut file = plain();
    file.json["materials"][1] = material;
    extensions.iter().for_each(|name| file.require(name));
    file
}

/// Adds an image and a texture of it, and returns the index of the texture.
fn add_texture(file: &mut File, image: &RgbaImage) -> usize {
    let view = file.view(&png(image));
    let image = file.push("images", json!({"bufferView": view, "mimeType": "image/png"}));
    file.push("textures", json!({"source": image}))
}

/// Gold, by factors.
pub(super) fn specular_glossiness() -> File {
    let gold =
        json!({"diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.77, 0.34], "glossinessFactor": 0.6});
    let material = json!({"doubleSided": true, "extensions": {"KHR_materials_pbrSpecularGlossiness": gold}});
    with_material(material, &["KHR_materials_pbrSpecularGlossiness"])
}

/// Gold rings on rough clay, by textures.
pub(super) fn specular_glossiness_map() -> File {
    let mut file = with_material(json!({"doubleSided": true}), &["KHR_materials_pbrSpecularGlossiness"]);
    let diffuse = add_texture(&mut file, &rings([0, 0, 0, 255], [196, 104, 62, 255]));
    let specular = add_texture(&mut file, &rings([255, 226, 158, 190], [56, 56, 56, 60]));
    file.json["materials"][1]["extensions"] = json!({"KHR_materials_pbrSpecularGlossiness": {
        "diffuseTexture": {"index": diffuse}, "specularGlossinessTexture": {"index": specular},
    }});
    file
}

/// The default material, and the variants "blue" and "bare".
pub(super) fn variants() -> File {
    let mut file = plain();
    let mut blue = file.json["materials"][1].clone();
    blue["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.2, 0.4, 1, 1]);
    let blue = file.push("materials", blue);
    let bare = file.push(
        "materials",
        json!({"doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.8, 0.75, 1], "metallicFactor": 0}}),
    );
    let mappings = json!([{"material": blue, "variants": [0]}, {"material": bare, "variants": [1]}]);
    file.json["meshes"][1]["primitives"][0]["extensions"] =
        json!({"KHR_materials_variants": {"mappings": mappings}});
    file.json["extensions"]["KHR_materials_variants"] =
        json!({"variants": [{"name": "blue"}, {"name": "bare"}]});
    file.require("KHR_materials_variants");
    file
}

fn glass_material(extensions: Value) -> Value {
    json!({
        "doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.1},
        "extensions": extensions,
    })
}

/// Clear glass.
pub(super) fn glass() -> File {
    let extensions = json!({"KHR_materials_transmission": {"transmissionFactor": 1}});
    with_material(glass_material(extensions), &["KHR_materials_transmission"])
}

/// Green glass: its volume absorbs the other colours.
pub(super) fn stained_glass() -> File {
    let extensions = json!({
        "KHR_materials_transmission": {"transmissionFactor": 1},
        "KHR_materials_ior": {"ior": 1.7},
        "KHR_materials_volume": {
            "thicknessFactor": 0.05, "attenuationDistance": 0.05, "attenuationColor": [0.1, 0.9, 0.3]},
    });
    let names = ["KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_volume"];
    with_material(glass_material(extensions), &names)
}

/// Glass with opaque rings, by a texture of transmission.
pub(super) fn label() -> File {
    let mut file = with_material(glass_material(json!({})), &["KHR_materials_transmission"]);
    let texture = add_texture(&mut file, &rings([0, 0, 0, 255], [255; 4]));
    file.json["materials"][1]["extensions"] = json!({"KHR_materials_transmission": {
        "transmissionFactor": 1, "transmissionTexture": {"index": texture}}});
    file
}

/// Rings whose shadow is clipped at another alpha than the vase itself.
pub(super) fn caster_modes() -> File {
    let mut file = plain();
    let texture = add_texture(&mut file, &rings([200, 90, 40, 255], [200, 90, 40, 150]));
    file.json["materials"][1] = json!({
        "doubleSided": true, "alphaMode": "MASK", "alphaCutoff": 0.2,
        "pbrMetallicRoughness": {
            "baseColorTexture": {"index": texture}, "metallicFactor": 0, "roughnessFactor": 0.4},
        "extras": {"shadow_casts": "clip", "shadow_cutoff": 0.8},
    });
    file
}

/// A dark gradient of vertex colours.
pub(super) fn vertex_colors() -> File {
    let mut file = with_primitive(|file, vase| {
        let color = |[_, y, _]: &[f32; 3]| [0.08 * y / 1.2, 0.01, 0.08 * (1.0 - y / 1.2), 1.0];
        let colors: Vec<u8> = vase
            .positions
            .iter()
            .flat_map(color)
            .flat_map(|channel| ((channel * 65535.0).round() as u16).to_le_bytes())
            .collect();
        let mut primitive = vase.primitive(file);
        let colors = file.accessor(&colors, 5123, "VEC4", vase.positions.len());
        file.json["accessors"][colors]["normalized"] = json!(true);
        primitive["attributes"]["COLOR_0"] = json!(colors);
        primitive
    });
    file.json["materials"][1] = json!({"doubleSided": true, "pbrMetallicRoughness": {"metallicFactor": 0}});
    file
}

/// A material with a coat, which is not drawn.
pub(super) fn clearcoat() -> File {
    let mut file = plain();
    file.json["materials"][1]["extensions"] = json!({"KHR_materials_clearcoat": {"clearcoatFactor": 1}});
    file.push("extensionsUsed", json!("KHR_materials_clearcoat"));
    file
}
