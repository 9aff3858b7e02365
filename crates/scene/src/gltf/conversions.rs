//! Materials whose images are computed from those of the file.

use super::materials::{Conversion, FileMaterial};
use super::notes::Notes;
use super::specular_glossiness::{SpecularGlossiness, converted_size};
use super::transmission::Transmission;
use crate::material::{AlphaMode, Image, TextureRef};

/// The maximum number of bytes of computed images in a scene.
const MAX_BYTES: usize = 1 << 30;

/// The decoded images of a file, and those that are computed from them.
pub(super) struct Images<'a> {
    pub(super) images: &'a mut Vec<Option<Image>>,
    bytes_left: usize,
}

impl<'a> Images<'a> {
    pub(super) fn new(images: &'a mut Vec<Option<Image>>) -> Self {
        Self { images, bytes_left: MAX_BYTES }
    }

    /// Computes the images of a material.
    pub(super) fn convert(&mut self, material: &mut FileMaterial, notes: &mut Notes) {
        let converted = match material.conversion {
            None => Some(()),
            Some(Conversion::SpecularGlossiness(factors)) => self.specular_glossiness(material, &factors),
            Some(Conversion::Transmission { transmission, mask }) => {
                self.transmission(material, &transmission, mask)
            }
        };
        if converted.is_none() {
            notes.add(
                format!("material {:?}", material.material.name),
                format!("its converted images would exceed {MAX_BYTES} bytes, and are left out"),
            );
        }
    }

    /// `None` if there is no space left.
    fn specular_glossiness(
        &mut self,
        material: &mut FileMaterial,
        factors: &SpecularGlossiness,
    ) -> Option<()> {
        let [diffuse, specular_glossiness, ..] = material.images;
        let image = |index: Option<usize>| self.images.get(index?)?.as_ref();
        let Some(source) = image(specular_glossiness) else { return Some(()) };
        let converted = &mut material.material;
        let reference = converted.metallic_roughness_texture?;
        let same_place = converted.base_color_texture.is_none_or(|base_color| {
            (base_color.uv_set, base_color.uv_transform) == (reference.uv_set, reference.uv_transform)
        });
        let diffuse = image(diffuse).filter(|_| same_place);
        let (width, height) = converted_size(diffuse, source);
        let bytes = (width as usize).checked_mul(height as usize)?.checked_mul(2 * 4)?;
        let bytes_left = self.bytes_left.checked_sub(bytes)?;
        let [base_color, metallic_roughness] = factors.convert_images(diffuse, source);
        self.bytes_left = bytes_left;
        // Where the textures are placed differently, that of diffuse colour is used as it is.
        if same_place {
            converted.base_color_texture = Some(converted.base_color_texture.unwrap_or(reference));
            converted.base_color = glam::Vec4::ONE;
            material.images[0] = Some(self.push(base_color));
        }
        (converted.metallic, converted.roughness) = (1.0, 1.0);
        material.images[1] = Some(self.push(metallic_roughness));
        Some(())
    }

    /// `None` if there is no space left.
    fn transmission(
        &mut self,
        material: &mut FileMaterial,
        transmission: &Transmission,
        mask: Option<(TextureRef, usize)>,
    ) -> Option<()> {
        let base_color = self.get(material.images[0]);
        let mask = mask.and_then(|(reference, index)| Some((reference, self.get(Some(index))?)));
        let opaque =
            base_color.is_none_or(|image| image.rgba8.as_chunks::<4>().0.iter().all(|p| p[3] == 255));
        let image = match (mask, base_color) {
            (None, Some(image)) if !opaque => {
                let alpha = |[r, g, b, _]: [u8; 4]| [r, g, b, 255];
                let rgba8 = image.rgba8.as_chunks::<4>().0.iter().copied().flat_map(alpha).collect();
                Image::new(image.name.clone(), image.width, image.height, rgba8)
            }
            (None, _) => return Some(()),
            (Some((reference, mask)), base_color) => {
                let material = &mut material.material;
                material.base_color_texture = Some(material.base_color_texture.unwrap_or(reference));
                material.base_color.w = 1.0;
                transmission.masked(base_color, mask)
            }
        };
        self.bytes_left = self.bytes_left.checked_sub(image.rgba8.len())?;
        material.images[0] = Some(self.push(image));
        material.material.alpha = AlphaMode::Transmit;
        Some(())
    }

    fn get(&self, index: Option<usize>) -> Option<&Image> {
        self.images.get(index?)?.as_ref()
    }

    fn push(&mut self, image: Image) -> usize {
        self.images.push(Some(image));
        self.images.len() - 1
    }
}
