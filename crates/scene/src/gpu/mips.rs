//! Mip levels of an image: each pixel is the mean of four pixels of the level above.

use std::sync::LazyLock;

use super::coverage::Coverage;
use crate::material::{Image, linear_from_srgb, srgb_from_linear};

/// The colour encoding of an image. Alpha is always linear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Encoding {
    /// Values, not colours: averaged directly.
    Linear,
    /// Colours in sRGB: averaged as linear light, weighted by alpha.
    Srgb,
    /// Only alpha.
    Alpha,
}

/// One level of an image.
#[derive(Clone, Copy)]
pub(super) struct Level<'a> {
    pub(super) number: u32,
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) rgba8: &'a [u8],
}

/// Returns the number of levels of an image, down to a single pixel.
pub(super) fn level_count(width: u32, height: u32) -> u32 {
    width.max(height).max(1).ilog2() + 1
}

/// Computes every level in turn, the image itself first. With `cutoff` (an alpha, 1 to 255) each level keeps the
/// image's fraction of pixels at or above it; otherwise leaves and wires would thin out with distance.
pub(super) fn for_each_level(
    image: &Image,
    encoding: Encoding,
    cutoff: Option<u8>,
    mut visit: impl FnMut(Level<'_>),
) {
    let (mut width, mut height) = (image.width, image.height);
    visit(Level { number: 0, width, height, rgba8: &image.rgba8 });
    let coverage = cutoff.map(|cutoff| Coverage::measure(&image.rgba8, width, cutoff));
    let mut above: Option<Vec<u8>> = None;
    for number in 1..level_count(width, height) {
        let pixels = halved(above.as_deref().unwrap_or(&image.rgba8), width, height, encoding);
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
        let scaled = coverage.as_ref().map(|coverage| coverage.scale_alpha(&pixels, width));
        let rgba8 = scaled.as_deref().unwrap_or(&pixels);
        visit(Level { number, width, height, rgba8 });
        above = Some(pixels);
    }
}

/// Halves both dimensions (not below 1). The last row or column of an odd dimension is dropped.
fn halved(pixels: &[u8], width: u32, height: u32, encoding: Encoding) -> Vec<u8> {
    let stride = width as usize * 4;
    let (half_width, half_height) = ((width as usize / 2).max(1), (height as usize / 2).max(1));
    let mut halved = vec![0; half_width * half_height * 4];
    let tables = &*TABLES;
    // A dimension of 1 uses its row or column twice.
    let lower = if height > 1 { stride } else { 0 };
    for (y, out_row) in halved.chunks_exact_mut(half_width * 4).enumerate() {
        let top = &pixels[y * 2 * stride..][..stride];
        let bottom = &pixels[y * 2 * stride + lower..][..stride];
        if width == 1 {
            tables.mean(encoding, &[top, top].concat(), &[bottom, bottom].concat(), out_row);
            continue;
        }
        let pairs = top.chunks_exact(8).zip(bottom.chunks_exact(8));
        for ((top, bottom), out) in pairs.zip(out_row.chunks_exact_mut(4)) {
            tables.mean(encoding, top, bottom, out);
        }
    }
    halved
}

/// Lookup tables for sRGB decoding and encoding.
struct Tables {
    /// Linear light of a byte, 0 to 65535.
    light: [u32; 256],
    /// The byte of linear light in 16384 steps.
    byte: Vec<u8>,
}

static TABLES: LazyLock<Tables> = LazyLock::new(Tables::new);

impl Tables {
    fn new() -> Self {
        let light = |byte: usize| (linear_from_srgb(byte as u8) * 65535.0).round() as u32;
        let byte = |step: usize| srgb_from_linear((step as f64 + 0.5) / 16384.0);
        Self { light: std::array::from_fn(light), byte: (0..16384).map(byte).collect() }
    }

    /// Writes the mean of four pixels: two in `top`, two in `bottom`.
    fn mean(&self, encoding: Encoding, top: &[u8], bottom: &[u8], out: &mut [u8]) {
        let (Ok(top), Ok(bottom)) = (<&[u8; 8]>::try_from(top), <&[u8; 8]>::try_from(bottom)) else { return };
        let bytes = |channel: usize| [top[channel], top[channel + 4], bottom[channel], bottom[channel + 4]];
        let light = |byte: u8| self.light[usize::from(byte)];
        let plain = |channel: usize| {
            let [a, b, c, d] = bytes(channel);
            ((u32::from(a) + u32::from(b) + u32::from(c) + u32::from(d) + 2) / 4) as u8
        };
        let alphas = bytes(3);
        let mean = match encoding {
            Encoding::Linear | Encoding::Alpha => [plain(0), plain(1), plain(2), plain(3)],
            Encoding::Srgb if alphas == [alphas[0]; 4] => {
                let even = |channel: usize| {
                    let [a, b, c, d] = bytes(channel);
                    self.byte[((light(a) + light(b) + light(c) + light(d)) / 16) as usize]
                };
                [even(0), even(1), even(2), alphas[0]]
            }
            Encoding::Srgb => {
                let [of_a, of_b, of_c, of_d] = alphas.map(u32::from);
                // Not all alphas are equal, so one is above 0.
                let total = of_a + of_b + of_c + of_d;
                let weighted = |channel: usize| {
                    let [a, b, c, d] = bytes(channel);
                    let sum = light(a) * of_a + light(b) * of_b + light(c) * of_c + light(d) * of_d;
                    self.byte[(sum / (total * 4)) as usize]
                };
                [weighted(0), weighted(1), weighted(2), plain(3)]
            }
        };
        out.copy_from_slice(&mean);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn levels(image: &Image, encoding: Encoding, cutoff: Option<u8>) -> Vec<(u32, u32, Vec<u8>)> {
        let mut levels = Vec::new();
        for_each_level(image, encoding, cutoff, |level| {
            assert_eq!(level.number as usize, levels.len());
            levels.push((level.width, level.height, level.rgba8.to_vec()));
        });
        levels
    }

    fn image(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let rgba8 = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
        let rgba8 = rgba8.flat_map(|(x, y)| pixel(x, y)).collect();
        Image::new("", width, height, rgba8)
    }

    #[test]
    fn uniform_colors_do_not_change() {
        for encoding in [Encoding::Linear, Encoding::Srgb] {
            for value in 0..=255 {
                let even = image(2, 2, |_, _| [value, 255 - value, value, value]);
                assert_eq!(levels(&even, encoding, None)[1].2, even.rgba8[..4], "{value} {encoding:?}");
            }
        }
    }

    #[test]
    fn colors_are_averaged_as_light_and_values_directly() {
        let checker = image(2, 2, |x, y| if (x + y) % 2 == 0 { [0, 0, 0, 255] } else { [255; 4] });
        // Half the light is 188 in sRGB.
        assert_eq!(levels(&checker, Encoding::Srgb, None)[1].2, [188, 188, 188, 255]);
        assert_eq!(levels(&checker, Encoding::Linear, None)[1].2, [128, 128, 128, 255]);
    }

    #[test]
    fn invisible_pixels_do_not_color_their_neighbours() {
        let leaf = image(2, 2, |x, _| if x == 0 { [20, 200, 30, 255] } else { [255, 255, 255, 0] });
        assert_eq!(levels(&leaf, Encoding::Srgb, None)[1].2, [20, 200, 30, 128]);
    }

    #[test]
    fn levels_go_down_to_one_pixel_for_any_shape() {
        for (width, height, count) in [(1, 1, 1), (7, 3, 3), (1, 9, 4), (16, 1, 5), (256, 256, 9)] {
            let levels = levels(&image(width, height, |_, _| [9; 4]), Encoding::Srgb, None);
            assert_eq!(levels.len(), count);
            assert_eq!(levels.len() as u32, level_count(width, height));
            for (width, height, pixels) in &levels {
                assert_eq!(pixels.len() as u32, width * height * 4);
                assert!(pixels.iter().all(|&byte| byte == 9));
            }
            assert_eq!((levels[count - 1].0, levels[count - 1].1), (1, 1));
        }
    }
}
