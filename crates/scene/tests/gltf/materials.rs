//! Import of materials, textures and images.

use glam::{Vec3, Vec4};
use serde_json::json;
use shadowgraph_scene::{AlphaMode, CasterMode, Filter, ShadowCasting, Wrap};

use crate::builder::File;

/// Writes a PNG of one pixel.
pub(crate) fn write_png(file: &File, name: &str, color: [u8; 4]) {
    image::RgbaImage::from_pixel(1, 1, image::Rgba(color)).save(file.directory.path().join(name)).unwrap();
}

#[test]
fn materials_keep_factors_textures_and_extensions() {
    let mut file = File::triangle();
    write_png(&file, "a.png", [1, 2, 3, 4]);
    write_png(&file, "b.png", [5, 6, 7, 8]);
    file.json["images"] = json!([{"uri": "unused.png"}, {"uri": "b.png"}, {"uri": "a.png", "name": "A"}]);
    file.json["samplers"] = json!([{"magFilter": 9728, "minFilter": 9985, "wrapS": 33071, "wrapT": 33648}]);
    file.json["textures"] = json!([{"source": 2}, {"source": 1, "sampler": 0}]);
    let transform = |offset: f32| json!({"KHR_texture_transform": {"offset": [offset, 0], "texCoord": 1}});
    file.json["materials"] = json!([{
        "name": "m",
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 0.5, "roughnessFactor": 0.6,
            "baseColorTexture": {"index": 0, "extensions": transform(0.5)},
            "metallicRoughnessTexture": {"index": 1},
        },
        "normalTexture": {"index": 1, "scale": 2, "extensions": transform(0.25)},
        "occlusionTexture": {"index": 0, "strength": 0.7, "texCoord": 1},
        "emissiveTexture": {"index": 0}, "emissiveFactor": [1, 0.5, 0],
        "alphaMode": "MASK", "alphaCutoff": 0.3, "doubleSided": true,
        "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength": {"emissiveStrength": 4}},
    }]);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let scene = file.load().unwrap();
    let images: Vec<_> =
        scene.images().map(|(_, image)| (image.name.as_str(), image.rgba8.as_slice())).collect();
    assert_eq!(images, [("b.png", &[5, 6, 7, 8][..]), ("A", &[1, 2, 3, 4])]);
    let [b, a] = [0, 1].map(|n| scene.images().nth(n).unwrap().0);
    let (_, material) = scene.materials().next().unwrap();
    assert_eq!(
        (material.base_color, material.emissive),
        (Vec4::new(0.1, 0.2, 0.3, 0.4), Vec3::new(4.0, 2.0, 0.0))
    );
    assert_eq!((material.metallic, material.roughness), (0.5, 0.6));
    assert_eq!((material.normal_scale, material.occlusion_strength), (2.0, 0.7));
    assert_eq!(
        (material.alpha, material.double_sided, material.unlit),
        (AlphaMode::Mask { cutoff: 0.3 }, true, true)
    );
    let base = material.base_color_texture.unwrap();
    assert_eq!((base.image, base.uv_set, base.uv_transform[0][2]), (a, 1, 0.5));
    let normal = material.normal_texture.unwrap();
    assert_eq!((normal.image, normal.uv_set, normal.uv_transform[0][2]), (b, 1, 0.25));
    assert_eq!((normal.sampler.wrap_u, normal.sampler.wrap_v), (Wrap::ClampToEdge, Wrap::MirrorRepeat));
    assert_eq!((normal.sampler.mag, normal.sampler.min), (Filter::Nearest, Filter::Linear));
    assert_eq!(normal.sampler.mip, Some(Filter::Nearest));
    assert_eq!(material.occlusion_texture.unwrap().uv_set, 1);
    assert_eq!(material.emissive_texture.unwrap().image, a);
}

#[test]
fn sixteen_bit_images_are_converted_to_8_bit() {
    let mut file = File::triangle();
    let pixel = image::Rgb([0xFFFFu16, 0x8080, 0]);
    let path = file.directory.path().join("deep.png");
    image::ImageBuffer::<image::Rgb<u16>, Vec<u16>>::from_pixel(2, 1, pixel).save(path).unwrap();
    file.json["images"] = json!([{"uri": "deep.png"}]);
    file.json["textures"] = json!([{"source": 0}]);
    file.json["materials"] = json!([{"emissiveTexture": {"index": 0}}]);
    let scene = file.load().unwrap();
    let (_, image) = scene.images().next().unwrap();
    assert_eq!((image.width, image.height), (2, 1));
    assert_eq!(image.rgba8, [255, 128, 0, 255, 255, 128, 0, 255]);
}

#[test]
fn tangents_are_generated_for_materials_with_a_normal_map() {
    let mut file = File::triangle();
    file.attribute("NORMAL", "VEC3", &[0.0, 0.0, 1.0].repeat(3));
    // u increases along +Y.
    file.attribute("TEXCOORD_0", "VEC2", &[0.0, 0.0, 0.0, 1.0, 1.0, 0.0]);
    write_png(&file, "n.png", [128, 128, 255, 255]);
    file.json["images"] = json!([{"uri": "n.png"}]);
    file.json["textures"] = json!([{"source": 0}]);
    file.json["materials"] = json!([{"normalTexture": {"index": 0}}]);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    let scene = file.load().unwrap();
    let (_, mesh) = scene.meshes().next().unwrap();
    assert!(mesh.vertices.iter().all(|vertex| vertex.tangent == [0.0, 1.0, 0.0, 1.0]));
}

#[test]
fn shadow_modes_are_read_from_extras() {
    let mut file = File::triangle();
    file.json["materials"] = json!([
        {"extras": {"shadow_casts": "Clip", "shadow_cutoff": 0.3, "shadow_receives": false, "other": [1, {}]}},
        {"extras": {"shadow_casts": false, "shadow_receives": 1}},
        {"name": "odd", "extras": {"shadow_casts": "maybe", "shadow_cutoff": 3, "shadow_receives": "no"}},
        {"extras": "text"},
    ]);
    file.json["meshes"][0]["primitives"][0]["material"] = json!(0);
    file.json["nodes"][0]["extras"] = json!({"shadow_casts": "only", "shadow_receives": false});
    let scene = file.load().unwrap();
    let modes = |n| {
        let (_, material) = scene.materials().nth(n).unwrap();
        (material.casts, material.shadow_cutoff, material.receives_shadows)
    };
    assert_eq!(modes(0), (Some(CasterMode::Clip), Some(0.3), false));
    assert_eq!(modes(1), (Some(CasterMode::Off), None, true));
    assert_eq!((modes(2), modes(3)), ((None, None, true), (None, None, true)));
    let (_, instance) = scene.instances().next().unwrap();
    assert_eq!((instance.casts, instance.receives_shadows), (ShadowCasting::ShadowOnly, false));
    assert_eq!(
        scene.notes,
        [
            "material 2 \"odd\": extras shadow_casts \"maybe\" is ignored (allowed: on, clip, dither, tint, off)",
            "material 2 \"odd\": extras shadow_cutoff 3 is ignored (allowed: 0 to 1)",
            "material 2 \"odd\": extras shadow_receives \"no\" is ignored (allowed: true, false)",
        ]
    );
}
