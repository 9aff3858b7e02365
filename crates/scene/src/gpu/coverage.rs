//! The alpha coverage of alpha-tested images, and its preservation in their mip levels.

/// The maximum number of pixels that are measured in a level; in a larger level rows are skipped.
const MAX_PIXELS: usize = 1 << 16;

/// The fraction of an image in which alpha is at least a cutoff.
pub(super) struct Coverage {
    cutoff: u8,
    fraction: f64,
}

impl Coverage {
    /// Measures an image with rows of `width` pixels of 4 bytes, alpha last.
    pub(super) fn measure(pixels: &[u8], width: u32, cutoff: u8) -> Self {
        let (counts, total) = interpolated_alphas(pixels, width as usize);
        let covered: u32 = counts[usize::from(cutoff)..].iter().sum();
        Self { cutoff, fraction: f64::from(covered) / f64::from(total.max(1)) }
    }

    /// Returns a level with its alpha scaled so that the same fraction reaches the cutoff, as nearly as possible.
    pub(super) fn scale_alpha(&self, pixels: &[u8], width: u32) -> Vec<u8> {
        let (counts, total) = interpolated_alphas(pixels, width as usize);
        let wanted = self.fraction * f64::from(total);
        // The smallest alpha to count so that the fraction comes closest; 256, which no pixel reaches, means no pixel.
        let (mut reached, mut best, mut best_error) = (0.0, 256, wanted);
        for alpha in (1..=255_u32).rev().filter(|&alpha| counts[alpha as usize] > 0) {
            reached += f64::from(counts[alpha as usize]);
            let error = (reached - wanted).abs();
            if error <= best_error {
                (best, best_error) = (alpha, error);
            }
        }
        let cutoff = u32::from(self.cutoff);
        // Rounded so that `best` reaches the cutoff and an alpha just below it does not.
        let round_up = if best < cutoff { best - 1 } else { 0 };
        let mut scaled = pixels.to_vec();
        for pixel in scaled.chunks_exact_mut(4) {
            pixel[3] = ((u32::from(pixel[3]) * cutoff + round_up) / best).min(255) as u8;
        }
        scaled
    }
}

/// Counts the alphas of linear filtering at 4 x 4 points between every four pixels, and returns their total too.
fn interpolated_alphas(pixels: &[u8], width: usize) -> ([u32; 256], u32) {
    let (width, mut counts, mut total) = (width.max(1), [0; 256], 0);
    let height = pixels.len() / 4 / width;
    let alpha = |x: usize, y: usize| u32::from(pixels[(y * width + x) * 4 + 3]);
    let step = (width * height).div_ceil(MAX_PIXELS).max(1);
    for y in (0..height).step_by(step) {
        let below = (y + 1).min(height - 1);
        for x in 0..width {
            let right = (x + 1).min(width - 1);
            let corners = [alpha(x, y), alpha(right, y), alpha(x, below), alpha(right, below)];
            count_between(corners, &mut counts);
            total += 16;
        }
    }
    (counts, total)
}

/// Counts the alphas at 4 x 4 points between four pixels: left and right, first above, then below.
fn count_between(corners: [u32; 4], counts: &mut [u32; 256]) {
    if corners == [corners[0]; 4] {
        counts[corners[0] as usize & 255] += 16;
        return;
    }
    for down in [1, 3, 5, 7] {
        let left = corners[0] * (8 - down) + corners[2] * down;
        let right = corners[1] * (8 - down) + corners[3] * down;
        for across in [1, 3, 5, 7] {
            counts[((left * (8 - across) + right * across) / 64) as usize & 255] += 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::mips::{Encoding, for_each_level};
    use super::*;
    use crate::material::Image;

    fn image(size: u32, alpha: impl Fn(u32, u32) -> u8) -> Image {
        let texel = |i: u32| [0, 0, 0, alpha(i % size, i / size)];
        let rgba8 = (0..size * size).flat_map(texel).collect();
        Image::new("", size, size, rgba8)
    }

    /// Returns the fraction of each level that reaches half alpha.
    fn fractions(image: &Image, cutoff: Option<u8>) -> Vec<f64> {
        let mut fractions = Vec::new();
        for_each_level(image, Encoding::Srgb, cutoff, |level| {
            fractions.push(Coverage::measure(level.rgba8, level.width, 128).fraction);
        });
        fractions
    }

    #[test]
    fn thin_wires_do_not_vanish_from_the_smaller_levels() {
        let wires = image(64, |x, _| if x % 8 == 0 { 255 } else { 0 });
        assert_eq!(fractions(&wires, None)[2], 0.0);
        for fraction in &fractions(&wires, Some(128))[..3] {
            assert!((0.1..=0.3).contains(fraction), "{fraction}");
        }
    }

    #[test]
    fn speckles_keep_their_coverage() {
        // Discs of many sizes, like distant leaves.
        let leaves = image(256, |x, y| {
            let (cell_x, cell_y) = (x / 16, y / 16);
            let radius = 3 + (cell_x * 7 + cell_y * 5) % 5;
            let (dx, dy) = (x % 16, y % 16);
            if dx.abs_diff(8).pow(2) + dy.abs_diff(8).pow(2) <= radius.pow(2) { 255 } else { 0 }
        });
        let kept = fractions(&leaves, Some(128));
        for fraction in &kept[1..5] {
            assert!((fraction - kept[0]).abs() < 0.06, "{fraction} of {}", kept[0]);
        }
    }

    #[test]
    fn full_and_empty_images_keep_their_coverage() {
        for (alpha, fraction) in [(255, 1.0), (0, 0.0)] {
            assert!(fractions(&image(8, |_, _| alpha), Some(200)).iter().all(|&each| each == fraction));
        }
    }

    #[test]
    fn a_large_image_is_measured_by_some_of_its_rows() {
        let half = image(1024, |x, _| if x < 512 { 255 } else { 0 });
        assert!((Coverage::measure(&half.rgba8, 1024, 128).fraction - 0.5).abs() < 0.01);
    }
}
