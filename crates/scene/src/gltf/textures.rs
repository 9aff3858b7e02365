//! Conversion of samplers, texture coordinates and texture transforms.

use ::gltf::json;
use json::extensions::texture::TextureTransform;
use json::texture::{MagFilter, MinFilter, WrappingMode};
use json::validation::Checked;

use super::document::Document;
use super::error::{ImportError, WithLocation, describe};
use super::notes::Notes;
use crate::keys::ImageKey;
use crate::material::{Filter, Sampler, TextureRef, Wrap};

/// The use of a texture by a material, as in the file.
pub(super) struct TextureUse {
    texture: usize,
    uv_set: u32,
    transform: Option<TextureTransform>,
}

impl From<&json::texture::Info> for TextureUse {
    fn from(info: &json::texture::Info) -> Self {
        let transform = info.extensions.as_ref().and_then(|extensions| extensions.texture_transform.clone());
        Self { texture: info.index.value(), uv_set: info.tex_coord, transform }
    }
}

impl TextureUse {
    /// Reads the use of a texture whose type in the gltf crate leaves the transform unparsed.
    pub(super) fn with_raw_transform(
        texture: usize,
        uv_set: u32,
        transform: Option<&json::Value>,
    ) -> Result<Self, json::Error> {
        let transform = transform.map(|value| serde_json::from_value(value.clone())).transpose()?;
        Ok(Self { texture, uv_set, transform })
    }

    /// Returns the index of the texture in the file.
    pub(super) fn texture(&self) -> usize {
        self.texture
    }

    /// Converts to a [`TextureRef`] without the key of its image.
    ///
    /// # Errors
    /// The sampler or the transform has values that glTF does not allow.
    pub(super) fn convert(
        &self,
        document: &Document,
        location: &str,
        notes: &mut Notes,
    ) -> Result<TextureRef, ImportError> {
        let index = document.textures.get(self.texture).and_then(|texture| texture.sampler);
        let sampler = match index.map(|index| (index.value(), document.samplers.get(index.value()))) {
            None => Sampler::default(),
            Some((index, Some(sampler))) => convert_sampler(sampler)
                .with_location(|| describe("sampler", index, sampler.name.as_deref()))?,
            Some((index, None)) => {
                notes.add(location, format!("sampler {index} does not exist, the default is used"));
                Sampler::default()
            }
        };
        let uv_set = self.transform.as_ref().and_then(|transform| transform.tex_coord).unwrap_or(self.uv_set);
        let uv_set = u8::try_from(uv_set).ok().filter(|set| *set < 2).unwrap_or_else(|| {
            notes.add(location, "texture coordinates above TEXCOORD_1 are not supported, TEXCOORD_0 is used");
            0
        });
        let uv_transform = self.transform.as_ref().map_or(TextureRef::UV_IDENTITY, uv_transform);
        if !uv_transform.as_flattened().iter().all(|value| value.is_finite()) {
            return Err(ImportError::new(location, "KHR_texture_transform has values that are not finite"));
        }
        Ok(TextureRef { image: ImageKey::default(), sampler, uv_set, uv_transform })
    }
}

/// The extensions that name another image of a texture, the preferred one first.
const SOURCES: [&str; 2] = ["KHR_texture_basisu", "EXT_texture_webp"];

/// Returns the index in the file of the image of a texture.
///
/// # Errors
/// The message says why the texture has no image.
pub(super) fn image_index(document: &Document, texture: usize) -> Result<usize, String> {
    let Some(json) = document.textures.get(texture) else {
        return Err(format!("texture {texture} does not exist"));
    };
    let extension = |name: &&str| json.extensions.as_ref()?.others.get(*name)?.get("source")?.as_u64();
    let source = SOURCES.iter().find_map(extension).unwrap_or(json.source.value() as u64);
    // The value of the gltf crate for a missing source.
    if source == u64::from(u32::MAX) {
        return Err(format!("texture {texture} has no image that can be read"));
    }
    let image = usize::try_from(source).ok().filter(|image| *image < document.images.len());
    image.ok_or_else(|| format!("texture {texture} has image {source}, which does not exist"))
}

/// Combines scale, rotation and offset, applied in this order.
fn uv_transform(transform: &TextureTransform) -> [[f32; 3]; 2] {
    let ([offset_u, offset_v], [scale_u, scale_v]) = (transform.offset.0, transform.scale.0);
    // Texture coordinates are rotated counter-clockwise as seen with v upwards, and v points down.
    let (sin, cos) = transform.rotation.0.sin_cos();
    [[cos * scale_u, sin * scale_v, offset_u], [-sin * scale_u, cos * scale_v, offset_v]]
}

fn convert_sampler(sampler: &json::texture::Sampler) -> Result<Sampler, &'static str> {
    let wrap = |wrap: Checked<WrappingMode>| match wrap {
        Checked::Valid(WrappingMode::Repeat) => Ok(Wrap::Repeat),
        Checked::Valid(WrappingMode::MirroredRepeat) => Ok(Wrap::MirrorRepeat),
        Checked::Valid(WrappingMode::ClampToEdge) => Ok(Wrap::ClampToEdge),
        Checked::Invalid => Err("unknown wrap mode (allowed: 10497, 33071, 33648)"),
    };
    let mag = match sampler.mag_filter {
        None | Some(Checked::Valid(MagFilter::Linear)) => Filter::Linear,
        Some(Checked::Valid(MagFilter::Nearest)) => Filter::Nearest,
        Some(Checked::Invalid) => return Err("unknown magFilter (allowed: 9728, 9729)"),
    };
    let (min, mip) = match sampler.min_filter {
        None => (Filter::Linear, Some(Filter::Linear)),
        Some(Checked::Invalid) => return Err("unknown minFilter (allowed: 9728, 9729, 9984 to 9987)"),
        Some(Checked::Valid(filter)) => match filter {
            MinFilter::Nearest => (Filter::Nearest, None),
            MinFilter::Linear => (Filter::Linear, None),
            MinFilter::NearestMipmapNearest => (Filter::Nearest, Some(Filter::Nearest)),
            MinFilter::LinearMipmapNearest => (Filter::Linear, Some(Filter::Nearest)),
            MinFilter::NearestMipmapLinear => (Filter::Nearest, Some(Filter::Linear)),
            MinFilter::LinearMipmapLinear => (Filter::Linear, Some(Filter::Linear)),
        },
    };
    Ok(Sampler { wrap_u: wrap(sampler.wrap_s)?, wrap_v: wrap(sampler.wrap_t)?, mag, min, mip })
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn transformed(json: &str, [u, v]: [f32; 2]) -> [f32; 2] {
        let rows = uv_transform(&serde_json::from_str(json).unwrap());
        rows.map(|[a, b, c]| ((a * u + b * v + c) * 1e4).round() / 1e4)
    }

    #[test]
    fn the_example_of_the_extension_shows_the_lower_left_quadrant() {
        // The extension's own example: the lower left quadrant of the image, turned clockwise.
        let quadrant = r#"{"offset": [0, 1], "rotation": 1.57079632679, "scale": [0.5, 0.5]}"#;
        assert_eq!(transformed(quadrant, [0.0, 0.0]), [0.0, 1.0]);
        assert_eq!(transformed(quadrant, [1.0, 1.0]), [0.5, 0.5]);
        assert_eq!(transformed(quadrant, [0.0, 1.0]), [0.5, 1.0]);
        assert_eq!(transformed(r#"{"offset": [0, 1], "scale": [1, -1]}"#, [0.25, 0.25]), [0.25, 0.75]);
    }
}
