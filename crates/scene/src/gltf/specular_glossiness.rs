//! Conversion of KHR_materials_pbrSpecularGlossiness to metallic-roughness, after the example of the extension.

use ::gltf::json::extensions::material::PbrSpecularGlossiness;
use glam::{Vec3, Vec4};

use super::transmission::texel;
use crate::material::{Image, linear_from_srgb, srgb_from_linear};

/// The specular reflectance of materials that are not metals.
const DIELECTRIC_SPECULAR: f32 = 0.04;
const EPSILON: f32 = 1e-4;

/// The factors of a specular-glossiness material; texture values multiply them.
#[derive(Clone, Copy, Debug)]
pub(super) struct SpecularGlossiness {
    /// Linear RGB and alpha.
    diffuse: Vec4,
    specular: Vec3,
    glossiness: f32,
}

/// The values of a metallic-roughness material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MetallicRoughness {
    pub(super) base_color: Vec4,
    pub(super) metallic: f32,
    pub(super) roughness: f32,
}

impl SpecularGlossiness {
    /// Reads the factors of the extension.
    ///
    /// # Errors
    /// A factor is not finite.
    pub(super) fn read(extension: &PbrSpecularGlossiness) -> Result<Self, String> {
        let diffuse = Vec4::from(extension.diffuse_factor.0);
        let specular = Vec3::from(extension.specular_factor.0);
        let glossiness = extension.glossiness_factor.0;
        if !(diffuse.is_finite() && specular.is_finite() && glossiness.is_finite()) {
            return Err("KHR_materials_pbrSpecularGlossiness has values that are not finite".into());
        }
        Ok(Self {
            diffuse: diffuse.clamp(Vec4::ZERO, Vec4::ONE),
            specular: specular.clamp(Vec3::ZERO, Vec3::ONE),
            glossiness: glossiness.clamp(0.0, 1.0),
        })
    }

    /// Converts the values at a point, with the linear values of the textures there.
    pub(super) fn convert(&self, diffuse: Vec4, specular_glossiness: Vec4) -> MetallicRoughness {
        let diffuse = self.diffuse * diffuse;
        let specular = self.specular * specular_glossiness.truncate();
        let color = diffuse.truncate();
        let not_specular = 1.0 - specular.max_element();
        let metallic = metallic(brightness(color), brightness(specular), not_specular);
        let from_diffuse =
            color * (not_specular / (1.0 - DIELECTRIC_SPECULAR) / (1.0 - metallic).max(EPSILON));
        let from_specular = (specular - DIELECTRIC_SPECULAR * (1.0 - metallic)) / metallic.max(EPSILON);
        let base_color = from_diffuse.lerp(from_specular, metallic * metallic);
        MetallicRoughness {
            base_color: base_color.clamp(Vec3::ZERO, Vec3::ONE).extend(diffuse.w),
            metallic,
            roughness: 1.0 - self.glossiness * specular_glossiness.w,
        }
    }

    /// Converts the textures to a base colour texture and a metallic and roughness texture of a size. The factors are in them.
    pub(super) fn convert_images(
        &self,
        diffuse: Option<&Image>,
        specular_glossiness: &Image,
        [width, height]: [u32; 2],
    ) -> [Image; 2] {
        let bytes = width as usize * height as usize * 4;
        let (mut base_color, mut metallic_roughness) = (Vec::with_capacity(bytes), Vec::with_capacity(bytes));
        for y in 0..height {
            for x in 0..width {
                let texel = |image: &Image| {
                    let [r, g, b, a] = texel(image, [x, y], [width, height]);
                    let [r, g, b] = [r, g, b].map(|channel| linear_from_srgb(channel) as f32);
                    Vec4::new(r, g, b, f32::from(a) / 255.0)
                };
                let converted = self.convert(diffuse.map_or(Vec4::ONE, texel), texel(specular_glossiness));
                let [r, g, b, a] = converted.base_color.to_array();
                base_color.extend([r, g, b].map(|channel| srgb_from_linear(channel.into())));
                base_color.push(byte(a));
                metallic_roughness.extend([255, byte(converted.roughness), byte(converted.metallic), 255]);
            }
        }
        let image = |kind: &str, rgba8| {
            Image::new(format!("{} ({kind})", specular_glossiness.name), width, height, rgba8)
        };
        [image("base colour", base_color), image("metallic and roughness", metallic_roughness)]
    }
}

fn byte(value: f32) -> u8 {
    (value.clamp(0.0, 1.0) * 255.0).round() as u8
}

/// Perceived brightness: ITU-R BT.601 weights of the squares.
fn brightness(color: Vec3) -> f32 {
    (color * color).dot(Vec3::new(0.299, 0.587, 0.114)).sqrt()
}

/// Returns the metalness with which a metallic-roughness material is as bright, diffuse and specular: the root of a quadratic
/// equation.
fn metallic(diffuse: f32, specular: f32, not_specular: f32) -> f32 {
    if specular < DIELECTRIC_SPECULAR {
        return 0.0;
    }
    let a = DIELECTRIC_SPECULAR;
    let b = diffuse * not_specular / (1.0 - DIELECTRIC_SPECULAR) + specular - 2.0 * DIELECTRIC_SPECULAR;
    let c = DIELECTRIC_SPECULAR - specular;
    let discriminant = (b * b - 4.0 * a * c).max(0.0);
    ((discriminant.sqrt() - b) / (2.0 * a)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn converted(diffuse: Vec3, specular: Vec3, glossiness: f32) -> MetallicRoughness {
        let factors = SpecularGlossiness { diffuse: diffuse.extend(1.0), specular, glossiness };
        factors.convert(Vec4::ONE, Vec4::ONE)
    }

    #[test]
    fn dielectrics_keep_their_colour_and_metals_take_that_of_their_highlights() {
        let red = Vec3::new(0.8, 0.1, 0.1);
        let plastic = converted(red, Vec3::splat(DIELECTRIC_SPECULAR), 0.75);
        assert!(plastic.base_color.truncate().abs_diff_eq(red, 1e-3), "{plastic:?}");
        assert_eq!((plastic.metallic, plastic.roughness), (0.0, 0.25));
        let gold = Vec3::new(1.0, 0.77, 0.34);
        let metal = converted(Vec3::ZERO, gold, 0.5);
        assert!(metal.metallic > 0.95 && metal.base_color.truncate().abs_diff_eq(gold, 0.02), "{metal:?}");
    }

    #[test]
    fn textures_of_different_sizes_are_converted_texel_by_texel() {
        let factors = SpecularGlossiness { diffuse: Vec4::ONE, specular: Vec3::ONE, glossiness: 1.0 };
        let diffuse = Image::new("diffuse", 1, 1, vec![255, 0, 0, 128]);
        // Black highlights: rough on the left, glossy on the right.
        let glossiness = Image::new("gloss", 2, 1, vec![0, 0, 0, 0, 0, 0, 0, 255]);
        let [base_color, metallic_roughness] = factors.convert_images(Some(&diffuse), &glossiness, [2, 1]);
        assert_eq!(base_color.rgba8, [255, 0, 0, 128, 255, 0, 0, 128]);
        assert_eq!(metallic_roughness.rgba8, [255, 255, 0, 255, 255, 0, 0, 255]);
    }
}
