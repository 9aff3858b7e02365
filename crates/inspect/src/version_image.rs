//! A version of a texture as an image.

use shadowgraph_core::{Contained, Extent, Plan, TexelLayout, TextureDesc};
use wgpu_types::TextureSampleType;

/// What texels that are NaN or infinite look like.
const NOT_FINITE: [u8; 3] = [255, 0, 255];

/// The texels that a pass has written, as an image: colours as they are stored, linear ones encoded as sRGB and limited to 0 to 1; depth and
/// integers stretched to their range. What is NaN or infinite is magenta.
#[derive(Clone, Debug, PartialEq)]
pub struct VersionImage {
    /// The path of the pass that wrote them.
    pub pass: String,
    /// Width and height. Layers lie below each other.
    pub size_px: [u32; 2],
    /// Three bytes for each pixel, in rows from the top.
    pub rgb8: Vec<u8>,
    /// The smallest and the largest value, where values are stretched.
    pub range: Option<[f64; 2]>,
}

impl VersionImage {
    /// Converts what a pass has written: of several mip levels, the one of `contained`.
    ///
    /// # Errors
    /// Why texels cannot be shown.
    pub fn new(plan: &Plan, desc: &TextureDesc, contained: &Contained) -> Result<Self, String> {
        let Contained { pass, part, bytes, .. } = contained;
        let bytes = bytes.as_ref().map_err(String::clone)?;
        let layout = TexelLayout::for_format(desc.format, part.selected_aspect())
            .ok_or_else(|| format!("texels of {:?} cannot be shown", desc.format))?;
        let Extent { width, height, .. } = desc.size.mip_level_size(part.first_mip(), desc.dimension);
        let [width, height] = part.bounds().map_or([width, height], |rect| [rect.width, rect.height]);
        let texels = || bytes.chunks_exact(layout.bytes()).filter_map(|texel| layout.values(texel));
        let layers = (bytes.len() / layout.bytes()) as u32 / (width * height).max(1);
        let kind = desc.format.sample_type(None, None);
        let is_color = matches!(kind, Some(TextureSampleType::Float { .. }));
        let range = (!is_color).then(|| range(texels()));
        // Bytes are stored as screens show them.
        let encoded = layout.bytes() == usize::from(desc.format.components());
        let rgb8 = texels().flat_map(|texel| match range {
            Some(range) => stretched(&texel, range),
            None if encoded => rgb(&texel, |value| value),
            None => rgb(&texel, srgb),
        });
        let rgb8 = rgb8.collect();
        let pass = pass.map(|pass| plan.pass_path(pass)).unwrap_or_default();
        Ok(Self { pass, size_px: [width, height * layers], rgb8, range })
    }
}

/// Returns the smallest and the largest finite value.
fn range(texels: impl Iterator<Item = Vec<f64>>) -> [f64; 2] {
    let finite = texels.flatten().filter(|value| value.is_finite());
    let [low, high] = finite
        .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if low <= high { [low, high] } else { [0.0, 0.0] }
}

fn stretched(texel: &[f64], [low, high]: [f64; 2]) -> [u8; 3] {
    rgb(texel, |value| (value - low) / (high - low).max(f64::MIN_POSITIVE))
}

/// Returns the colour of a texel: grey of one channel, black for what two do not have.
fn rgb(texel: &[f64], encode: impl Fn(f64) -> f64) -> [u8; 3] {
    let channels = match *texel {
        [value] => [value; 3],
        [red, green] => [red, green, 0.0],
        [red, green, blue, ..] => [red, green, blue],
        [] => [0.0; 3],
    };
    if channels.iter().any(|value| !value.is_finite()) {
        return NOT_FINITE;
    }
    channels.map(|value| (encode(value).clamp(0.0, 1.0) * 255.0).round() as u8)
}

/// Encodes a linear value (IEC 61966-2-1).
fn srgb(value: f64) -> f64 {
    if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use shadowgraph_core::{Contents, Format, Frame, Rect, ResourceId, Subresource};

    /// Returns the image of texels that the pass `draw` has written into a part of a texture.
    fn image(desc: TextureDesc, part: Subresource, bytes: &[u8]) -> Result<VersionImage, String> {
        let mut frame = Frame::new();
        let mut texture = frame.create_texture("texture", TextureDesc::d2(4, 4, Format::Rgba8Unorm));
        frame.render_pass("draw").color(&mut texture, Contents::clear_color([0.0; 4]));
        frame.export_texture(&texture);
        let id: ResourceId = texture.id();
        let plan = frame.compile().unwrap().into_plan();
        let pass = plan.find_pass("draw");
        let contained = Contained { pass, resource: id, version: 1, part, bytes: Ok(bytes.to_vec()) };
        VersionImage::new(&plan, &desc, &contained)
    }

    fn floats(values: &[f32]) -> Vec<u8> {
        values.iter().flat_map(|value| value.to_le_bytes()).collect()
    }

    #[test]
    fn colors_are_encoded_once_and_depth_is_stretched() {
        let bytes = image(TextureDesc::d2(1, 1, Format::Rgba8Unorm), Subresource::FULL, &[10, 20, 30, 40]);
        assert_eq!(bytes.unwrap().rgb8, [10, 20, 30]);
        let linear = floats(&[0.214_041_14, 7.0, -1.0, f32::NAN]);
        let linear = image(TextureDesc::d2(4, 1, Format::R32Float), Subresource::FULL, &linear).unwrap();
        assert_eq!(linear.rgb8, [[128; 3], [255; 3], [0; 3], NOT_FINITE].concat());
        assert_eq!((linear.pass.as_str(), linear.range), ("draw", None));
        let depth = floats(&[0.5, 0.75, 1.0, f32::INFINITY]);
        let depth = image(TextureDesc::d2(2, 2, Format::Depth32Float), Subresource::FULL, &depth).unwrap();
        assert_eq!(depth.rgb8, [[0; 3], [128; 3], [255; 3], NOT_FINITE].concat());
        assert_eq!((depth.size_px, depth.range), ([2, 2], Some([0.5, 1.0])));
        let same = image(TextureDesc::d2(2, 1, Format::R8Uint), Subresource::FULL, &[7, 7]).unwrap();
        assert_eq!((same.rgb8, same.range), (vec![0; 6], Some([7.0, 7.0])));
    }

    #[test]
    fn a_rectangle_has_its_own_size_and_layers_lie_below_each_other() {
        let tile = Subresource::FULL.rect(Rect::new(1, 1, 2, 1));
        let tile = image(TextureDesc::d2(4, 4, Format::R8Unorm), tile, &[1, 2]).unwrap();
        assert_eq!((tile.size_px, tile.rgb8), ([2, 1], vec![1, 1, 1, 2, 2, 2]));
        let mut layers = TextureDesc::d2(4, 2, Format::R8Unorm);
        layers.size.depth_or_array_layers = 3;
        assert_eq!(image(layers, Subresource::FULL.mip(1), &[1, 2, 3, 4, 5, 6]).unwrap().size_px, [2, 3]);
    }

    #[test]
    fn what_cannot_be_read_has_a_reason() {
        let packed = image(TextureDesc::d2(1, 1, Format::Rgb10a2Unorm), Subresource::FULL, &[0; 4]);
        assert_eq!(packed.unwrap_err(), "texels of Rgb10a2Unorm cannot be shown");
    }
}
