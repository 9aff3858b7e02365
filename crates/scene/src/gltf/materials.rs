//! Conversion of materials, and the images that they use.

use std::collections::BTreeSet;

use ::gltf::json;
use glam::{Vec3, Vec4};
use json::extensions::material::PbrSpecularGlossiness;
use json::validation::Checked;

use super::document::Document;
use super::error::{ImportError, WithLocation, clean_name, describe};
use super::extras;
use super::notes::Notes;
use super::specular_glossiness::SpecularGlossiness;
use super::textures::{self, TextureUse};
use super::transmission::Transmission;
use crate::material::{AlphaMode, Material, TextureRef};

const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";
/// Number of textures of a material.
const SLOTS: usize = 6;
/// The last of them.
const TRANSMISSION: usize = 5;

/// The materials of a file.
#[derive(Debug)]
pub(super) struct Materials {
    pub(super) materials: Vec<FileMaterial>,
    /// Indices in the file of the images that the materials use, ascending.
    pub(super) images: Vec<usize>,
}

/// A material, before its images are decoded.
#[derive(Clone, Debug, Default)]
pub(super) struct FileMaterial {
    /// The material. The keys of the images of its textures are not set.
    pub(super) material: Material,
    /// Index of the image of each texture among the images that the materials use.
    pub(super) images: [Option<usize>; 5],
    pub(super) conversion: Option<Conversion>,
}

/// A conversion of decoded images.
#[derive(Clone, Copy, Debug)]
pub(super) enum Conversion {
    /// The textures of base colour and of metalness and roughness are those of diffuse colour and of specular and glossiness.
    SpecularGlossiness(SpecularGlossiness),
    /// The alpha of the base colour texture has no meaning. `mask` is the texture of transmission and the index of its image.
    Transmission { transmission: Transmission, mask: Option<(TextureRef, usize)> },
}

/// Converts all materials of a file. A texture without an image is left out with a note.
///
/// # Errors
/// The location names the material or sampler with a value that glTF does not allow.
pub(super) fn read(document: &Document, notes: &mut Notes) -> Result<Materials, ImportError> {
    let mut textures = Vec::with_capacity(document.materials.len());
    let mut used = BTreeSet::new();
    for (i, material) in document.materials.iter().enumerate() {
        let location = describe_material(i, material);
        textures.push(Textures::read(document, material, &location, &mut used, notes)?);
    }
    note_unused_textures(document, &used, notes);
    let used = textures.iter().flat_map(|textures| textures.all.iter().flatten());
    let mut images: Vec<usize> = used.map(|(_, image)| *image).collect();
    images.sort_unstable();
    images.dedup();
    let mut materials = Vec::with_capacity(textures.len());
    for (i, (json, textures)) in document.materials.iter().zip(&textures).enumerate() {
        let location = describe_material(i, json);
        let [base_color, metallic_roughness, normal, occlusion, emissive, mask] =
            textures.convert(document, &location, notes)?;
        let references = [base_color, metallic_roughness, normal, occlusion, emissive];
        let mut used = textures.images().map(|image| images.binary_search(&image?).ok());
        let mask = mask.zip(used[TRANSMISSION].take());
        let [base_color, metallic_roughness, normal, occlusion, emissive, _] = used;
        let mut material = FileMaterial {
            material: convert(json, references, &location)?,
            images: [base_color, metallic_roughness, normal, occlusion, emissive],
            conversion: None,
        };
        material.extend(json, mask, notes).with_location(|| location.clone())?;
        extras::apply_to_material(&json.extras, &mut material.material, &location, notes);
        materials.push(material);
    }
    Ok(Materials { materials, images })
}

impl FileMaterial {
    /// Applies the extensions that need a conversion. `mask` is the texture of transmission.
    fn extend(
        &mut self,
        json: &json::Material,
        mask: Option<(TextureRef, usize)>,
        notes: &mut Notes,
    ) -> Result<(), String> {
        let material = &mut self.material;
        if let Some(extension) = specular_glossiness(json) {
            let factors = SpecularGlossiness::read(extension)?;
            let converted = factors.convert(Vec4::ONE, Vec4::ONE);
            material.base_color = converted.base_color;
            (material.metallic, material.roughness) = (converted.metallic, converted.roughness);
            self.conversion = Some(Conversion::SpecularGlossiness(factors));
        }
        let Some(transmission) = Transmission::read(json).transpose()? else { return Ok(()) };
        if matches!(material.alpha, AlphaMode::Mask { .. }) || self.conversion.is_some() {
            let location = format!("material {:?}", material.name);
            notes.add(location, "transmission through masked and specular-glossiness materials is not drawn");
            return Ok(());
        }
        let alpha = if material.alpha == AlphaMode::Opaque { 1.0 } else { material.base_color.w };
        let color = material.base_color.truncate() * transmission.tint;
        material.base_color = color.extend(alpha * (1.0 - transmission.factor));
        if material.alpha == AlphaMode::Opaque {
            self.conversion = Some(Conversion::Transmission { transmission, mask });
        }
        material.alpha = AlphaMode::Transmit;
        Ok(())
    }
}

fn specular_glossiness(material: &json::Material) -> Option<&PbrSpecularGlossiness> {
    material.extensions.as_ref()?.pbr_specular_glossiness.as_ref()
}

/// Adds a note for each texture without an image that no material uses.
fn note_unused_textures(document: &Document, used: &BTreeSet<usize>, notes: &mut Notes) {
    for (i, texture) in document.textures.iter().enumerate().filter(|(i, _)| !used.contains(i)) {
        if let Err(reason) = textures::image_index(document, i) {
            let location = describe("texture", i, texture.name.as_deref());
            notes.add(location, format!("is not used by a material, and {reason}"));
        }
    }
}

fn describe_material(index: usize, material: &json::Material) -> String {
    describe("material", index, material.name.as_deref())
}

/// The textures of a material, each with the index of its image in the file: base colour or diffuse colour, metallic and
/// roughness or specular and glossiness, normal, occlusion, emissive, transmission.
struct Textures {
    all: [Option<(TextureUse, usize)>; SLOTS],
}

impl Textures {
    /// Reads the textures of a material, and adds the indices of those that it names to `used`.
    fn read(
        document: &Document,
        material: &json::Material,
        location: &str,
        used: &mut BTreeSet<usize>,
        notes: &mut Notes,
    ) -> Result<Self, ImportError> {
        let mut all = [const { None }; SLOTS];
        for (texture, found) in Self::infos(material).into_iter().zip(&mut all) {
            let Some(texture) = texture.transpose().with_location(|| location)? else { continue };
            used.insert(texture.texture());
            match textures::image_index(document, texture.texture()) {
                Ok(image) => *found = Some((texture, image)),
                Err(reason) => notes.add(location, format!("{reason}; it is drawn without this texture")),
            }
        }
        Ok(Self { all })
    }

    fn infos(material: &json::Material) -> [Option<Result<TextureUse, json::Error>>; SLOTS] {
        let pbr = &material.pbr_metallic_roughness;
        let normal = material.normal_texture.as_ref().map(|info| {
            let transform = info.extensions.as_ref().and_then(|e| e.others.get(TEXTURE_TRANSFORM));
            TextureUse::with_raw_transform(info.index.value(), info.tex_coord, transform)
        });
        let occlusion = material.occlusion_texture.as_ref().map(|info| {
            let transform = info.extensions.as_ref().and_then(|e| e.others.get(TEXTURE_TRANSFORM));
            TextureUse::with_raw_transform(info.index.value(), info.tex_coord, transform)
        });
        let plain = |info: &Option<json::texture::Info>| info.as_ref().map(|info| Ok(TextureUse::from(info)));
        let (base_color, metallic_roughness) = match specular_glossiness(material) {
            Some(extension) => (&extension.diffuse_texture, &extension.specular_glossiness_texture),
            None => (&pbr.base_color_texture, &pbr.metallic_roughness_texture),
        };
        let transmission = material.extensions.as_ref().and_then(|e| e.transmission.as_ref());
        [
            plain(base_color),
            plain(metallic_roughness),
            normal,
            occlusion,
            plain(&material.emissive_texture),
            transmission.and_then(|transmission| plain(&transmission.transmission_texture)),
        ]
    }

    fn images(&self) -> [Option<usize>; SLOTS] {
        self.all.each_ref().map(|texture| texture.as_ref().map(|(_, image)| *image))
    }

    fn convert(
        &self,
        document: &Document,
        location: &str,
        notes: &mut Notes,
    ) -> Result<[Option<TextureRef>; SLOTS], ImportError> {
        let mut references = [None; SLOTS];
        for (texture, reference) in self.all.iter().zip(&mut references) {
            let Some((texture, _)) = texture else { continue };
            *reference = Some(texture.convert(document, location, notes)?);
        }
        Ok(references)
    }
}

fn convert(
    material: &json::Material,
    textures: [Option<TextureRef>; 5],
    location: &str,
) -> Result<Material, ImportError> {
    let pbr = &material.pbr_metallic_roughness;
    let finite = |name, value, min, max| clamped(name, value, min, max).with_location(|| location);
    let [r, g, b, a] = pbr.base_color_factor.0;
    let base = |value| finite("baseColorFactor", value, 0.0, 1.0);
    let strength = material.extensions.as_ref().and_then(|e| e.emissive_strength.as_ref());
    let strength = finite("emissiveStrength", strength.map_or(1.0, |s| s.emissive_strength.0), 0.0, 1e9)?;
    let [er, eg, eb] = material.emissive_factor.0;
    let emissive = |value| Ok(finite("emissiveFactor", value, 0.0, 1.0)? * strength);
    let [base_color_texture, metallic_roughness_texture, normal_texture, occlusion_texture, emissive_texture] =
        textures;
    let scale = material.normal_texture.as_ref().map_or(1.0, |normal| normal.scale);
    let occlusion = material.occlusion_texture.as_ref().map_or(1.0, |occlusion| occlusion.strength.0);
    Ok(Material {
        name: clean_name(material.name.as_deref()),
        base_color: Vec4::new(base(r)?, base(g)?, base(b)?, base(a)?),
        metallic: finite("metallicFactor", pbr.metallic_factor.0, 0.0, 1.0)?,
        roughness: finite("roughnessFactor", pbr.roughness_factor.0, 0.0, 1.0)?,
        emissive: Vec3::new(emissive(er)?, emissive(eg)?, emissive(eb)?),
        normal_scale: finite("normalTexture scale", scale, -1e6, 1e6)?,
        occlusion_strength: finite("occlusionTexture strength", occlusion, 0.0, 1.0)?,
        alpha: alpha(material).with_location(|| location)?,
        double_sided: material.double_sided,
        casts: None,
        shadow_cutoff: None,
        receives_shadows: true,
        unlit: material.extensions.as_ref().is_some_and(|e| e.unlit.is_some()),
        base_color_texture,
        metallic_roughness_texture,
        normal_texture,
        occlusion_texture,
        emissive_texture,
    })
}

fn alpha(material: &json::Material) -> Result<AlphaMode, String> {
    match material.alpha_mode {
        Checked::Valid(json::material::AlphaMode::Opaque) => Ok(AlphaMode::Opaque),
        Checked::Valid(json::material::AlphaMode::Blend) => Ok(AlphaMode::Blend),
        Checked::Valid(json::material::AlphaMode::Mask) => {
            let cutoff = material.alpha_cutoff.unwrap_or_default().0;
            Ok(AlphaMode::Mask { cutoff: clamped("alphaCutoff", cutoff, 0.0, f32::MAX)? })
        }
        Checked::Invalid => Err("unknown alphaMode (allowed: OPAQUE, MASK, BLEND)".into()),
    }
}

/// Clamps a value to its range; values slightly out of it are common and harmless.
fn clamped(name: &str, value: f32, min: f32, max: f32) -> Result<f32, String> {
    if value.is_finite() {
        Ok(value.clamp(min, max))
    } else {
        Err(format!("{name} is {value} (allowed: {min} to {max})"))
    }
}
