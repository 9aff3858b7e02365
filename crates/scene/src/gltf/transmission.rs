//! Transmission, volume and index of refraction, as a thin translucent surface.

use ::gltf::json;
use glam::Vec3;

use crate::material::Image;

/// Light that passes through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Transmission {
    /// The fraction of the light, 0 to 1; the texture multiplies it.
    pub(super) factor: f32,
    /// The colour that the volume behind the surface leaves.
    pub(super) tint: Vec3,
}

impl Transmission {
    /// Reads the extensions of a material; `None` if no light passes through it.
    ///
    /// # Errors
    /// A value is not finite, or out of range.
    pub(super) fn read(material: &json::Material) -> Option<Result<Self, String>> {
        let extensions = material.extensions.as_ref()?;
        let factor = extensions.transmission.as_ref()?.transmission_factor.0;
        if factor == 0.0 {
            return None;
        }
        if !factor.is_finite() {
            return Some(Err(format!("transmissionFactor is {factor} (allowed: 0 to 1)")));
        }
        let ior = extensions.ior.as_ref().map_or(1.5, |ior| ior.ior.0);
        // The extension uses 0 for a surface that reflects all light at grazing angles only; below 1 is not allowed.
        let reflected = if ior >= 1.0 { ((ior - 1.0) / (ior + 1.0)).powi(2) } else { 0.0 };
        let tint = extensions.volume.as_ref().map_or(Vec3::ONE, |volume| {
            let (thickness, distance) = (volume.thickness_factor.0, volume.attenuation_distance.0);
            let color = Vec3::from(volume.attenuation_color.0).clamp(Vec3::ZERO, Vec3::ONE);
            let exponent = thickness / distance;
            if exponent > 0.0 && color.is_finite() { color.powf(exponent) } else { Vec3::ONE }
        });
        Some(Ok(Self { factor: factor.clamp(0.0, 1.0) * (1.0 - reflected), tint }))
    }

    /// Returns a base colour image of a size whose alpha is what the transmission texture does not let through, and opaque without
    /// one. Without a base colour image it is white.
    pub(super) fn base_color(
        &self,
        base_color: Option<&Image>,
        transmission: Option<&Image>,
        size: [u32; 2],
    ) -> Image {
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let rgba8 = pixels.flat_map(|pixel| {
            let [r, g, b, _] = base_color.map_or([255; 4], |image| texel(image, pixel, size));
            let [transmitted, ..] = transmission.map_or([0; 4], |image| texel(image, pixel, size));
            [r, g, b, (255.0 - self.factor * f32::from(transmitted)).round() as u8]
        });
        let name = base_color.or(transmission).map_or("", |image| &image.name);
        Image::new(format!("{name} (transmission)"), size[0], size[1], rgba8.collect())
    }
}

/// Returns the texel of an image at a pixel of another size.
pub(super) fn texel(image: &Image, pixel: [u32; 2], size: [u32; 2]) -> [u8; 4] {
    let at = |pixel: u32, size: u32, own: u32| (u64::from(pixel) * u64::from(own) / u64::from(size)) as usize;
    let (x, y) = (at(pixel[0], size[0], image.width), at(pixel[1], size[1], image.height));
    image.rgba8.as_chunks::<4>().0.get(y * image.width as usize + x).copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    fn read(extensions: &str) -> Option<Transmission> {
        let material = serde_json::from_str(&format!("{{\"extensions\": {extensions}}}")).unwrap();
        Transmission::read(&material).map(Result::unwrap)
    }

    #[test]
    fn the_volume_tints_and_the_surface_reflects_by_its_index_of_refraction() {
        let glass = read(
            r#"{"KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_ior": {"ior": 3},
            "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 1, "attenuationColor": [1, 0.5, 0]}}"#,
        );
        assert_eq!(glass, Some(Transmission { factor: 0.75, tint: Vec3::new(1.0, 0.25, 0.0) }));
        assert_eq!(read(r#"{"KHR_materials_transmission": {}}"#), None);
        assert_eq!(read("{}"), None);
    }

    #[test]
    fn a_transmission_texture_becomes_alpha() {
        let transmission = Transmission { factor: 1.0, tint: Vec3::ONE };
        let mask = Image::new("mask", 2, 1, vec![255, 9, 9, 9, 0, 9, 9, 9]);
        let red = Image::new("red", 1, 1, vec![255, 0, 0, 7]);
        assert_eq!(
            transmission.base_color(Some(&red), Some(&mask), [2, 1]).rgba8,
            [255, 0, 0, 0, 255, 0, 0, 255]
        );
        assert_eq!(
            transmission.base_color(None, Some(&mask), [2, 1]).rgba8,
            [255, 255, 255, 0, 255, 255, 255, 255]
        );
        assert_eq!(transmission.base_color(Some(&red), None, [1, 1]).rgba8, [255, 0, 0, 255]);
    }
}
