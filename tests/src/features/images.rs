//! Images in other formats, and missing ones.

use image::ImageFormat;
use image::imageops::{FilterType, resize};
use serde_json::json;

use super::model::{encoded, plain, texture};
use crate::gltf_file::File;
use crate::ktx2::{self, Image};

/// A WebP image.
pub(super) fn webp() -> File {
    with_image("EXT_texture_webp", "image/webp", &encoded(&texture(), ImageFormat::WebP))
}

/// A KTX2 image of UASTC with all mip levels.
pub(super) fn uastc() -> File {
    with_image("KHR_texture_basisu", "image/ktx2", &ktx2::uastc(&levels(), true))
}

/// A KTX2 image of ETC1S with all mip levels.
pub(super) fn etc1s() -> File {
    with_image("KHR_texture_basisu", "image/ktx2", &ktx2::etc1s(&levels(), true))
}

/// A texture whose only image is that of an extension.
fn with_image(extension: &str, mime_type: &str, bytes: &[u8]) -> File {
    let mut file = plain();
    let view = file.view(bytes);
    file.json["images"] = json!([{"bufferView": view, "mimeType": mime_type}]);
    file.json["textures"] = json!([{"extensions": {extension: {"source": 0}}}]);
    file.require(extension);
    file
}

/// Returns the mip levels of the texture.
fn levels() -> Vec<Image> {
    let largest = texture();
    let sizes = (0..=largest.width().ilog2()).map(|level| largest.width() >> level);
    let level = |size| {
        let rgba = resize(&largest, size, size, FilterType::Triangle).into_raw();
        Image { width: size, height: size, rgba }
    };
    sizes.map(level).collect()
}

/// An image that does not exist.
pub(super) fn missing() -> File {
    let mut file = plain();
    file.json["images"] = json!([{"uri": "none.png"}]);
    file.json["materials"][1]["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.1, 0.5, 0.2, 1]);
    file
}

/// A texture without an image, and an unused one.
pub(super) fn no_source() -> File {
    let mut file = missing();
    file.json["images"] = json!([]);
    file.json["textures"] = json!([{}, {"source": 7}]);
    file
}
