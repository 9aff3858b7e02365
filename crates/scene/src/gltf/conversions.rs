//! Materials whose images are computed from those of the file.

use glam::Vec4;

use super::materials::{Conversion, FileMaterial};
use super::notes::Notes;
use super::specular_glossiness::SpecularGlossiness;
use super::transmission::Transmission;
use crate::material::{Image, TextureRef};

/// The maximum number of bytes of computed images in a scene.
const MAX_BYTES: usize = 1 << 30;

/// The decoded images of a file, and those that are computed from them.
pub(super) struct Images<'a> {
    images: &'a mut Vec<Option<Image>>,
    bytes_left: usize,
}

/// Why the images of a material are not computed.
const TOO_LARGE: &str =
    "its converted images would exceed 1 GiB, the limit of a scene; its factors are drawn";
const OTHER_PLACE: &str =
    "its transmission texture is placed differently than its base colour texture; its factor is drawn";

impl<'a> Images<'a> {
    pub(super) fn new(images: &'a mut Vec<Option<Image>>) -> Self {
        Self { images, bytes_left: MAX_BYTES }
    }

    /// Computes the images of a material. Otherwise it keeps its factors, with a note.
    pub(super) fn convert(&mut self, material: &mut FileMaterial, notes: &mut Notes) {
        let converted = match material.conversion {
            None => Ok(()),
            Some(Conversion::SpecularGlossiness(factors)) => self.specular_glossiness(material, &factors),
            Some(Conversion::Transmission { transmission, mask }) => {
                self.transmission(material, &transmission, mask)
            }
        };
        if let Err(reason) = converted {
            notes.add(format!("material {:?}", material.material.name), reason);
        }
    }

    fn specular_glossiness(
        &mut self,
        material: &mut FileMaterial,
        factors: &SpecularGlossiness,
    ) -> Result<(), &'static str> {
        let [diffuse, specular_glossiness, ..] = material.images;
        let converted = &mut material.material;
        let Some(reference) = converted.metallic_roughness_texture else { return Ok(()) };
        let same_place = converted.base_color_texture.is_none_or(|texture| same_place(&texture, &reference));
        let Some(size) = self.size([diffuse.filter(|_| same_place), specular_glossiness]) else {
            return Ok(());
        };
        self.take(size, 2)?;
        let Some(source) = self.get(specular_glossiness) else { return Ok(()) };
        let diffuse = self.get(diffuse).filter(|_| same_place);
        let [base_color, metallic_roughness] = factors.convert_images(diffuse, source, size);
        // Where the textures are placed differently, that of diffuse colour is used as it is.
        if same_place {
            converted.base_color_texture = Some(converted.base_color_texture.unwrap_or(reference));
            converted.base_color = Vec4::ONE;
            material.images[0] = Some(self.push(base_color));
        }
        (converted.metallic, converted.roughness) = (1.0, 1.0);
        material.images[1] = Some(self.push(metallic_roughness));
        Ok(())
    }

    fn transmission(
        &mut self,
        material: &mut FileMaterial,
        transmission: &Transmission,
        mask: Option<(TextureRef, usize)>,
    ) -> Result<(), &'static str> {
        let base_color = material.images[0];
        let mask = mask.filter(|(_, index)| self.get(Some(*index)).is_some());
        if mask.is_none() && self.get(base_color).is_none_or(Image::is_opaque) {
            return Ok(());
        }
        let converted = &mut material.material;
        let reference = converted.base_color_texture.or(mask.map(|(reference, _)| reference));
        if let (Some((mask, _)), Some(base_color)) = (&mask, &reference)
            && !same_place(mask, base_color)
        {
            return Err(OTHER_PLACE);
        }
        let mask = mask.map(|(_, index)| index);
        let Some(size) = self.size([base_color, mask]) else { return Ok(()) };
        self.take(size, 1)?;
        let image = transmission.base_color(self.get(base_color), self.get(mask), size);
        if mask.is_some() {
            converted.base_color.w = 1.0;
        }
        converted.base_color_texture = reference;
        material.images[0] = Some(self.push(image));
        Ok(())
    }

    fn get(&self, index: Option<usize>) -> Option<&Image> {
        self.images.get(index?)?.as_ref()
    }

    /// Returns the width and the height of an image that is as large as each of two; `None` if there is neither.
    fn size(&self, images: [Option<usize>; 2]) -> Option<[u32; 2]> {
        let sizes =
            images.into_iter().filter_map(|image| self.get(image)).map(|image| [image.width, image.height]);
        sizes.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
    }

    /// Counts the bytes of a number of images against the limit.
    fn take(&mut self, [width, height]: [u32; 2], count: usize) -> Result<(), &'static str> {
        let pixels = (width as usize).saturating_mul(height as usize);
        self.bytes_left = self.bytes_left.checked_sub(pixels.saturating_mul(4 * count)).ok_or(TOO_LARGE)?;
        Ok(())
    }

    fn push(&mut self, image: Image) -> usize {
        self.images.push(Some(image));
        self.images.len() - 1
    }
}

/// Returns whether two textures have their texels at the same points of a surface.
fn same_place(a: &TextureRef, b: &TextureRef) -> bool {
    (a.uv_set, a.uv_transform) == (b.uv_set, b.uv_transform)
}
