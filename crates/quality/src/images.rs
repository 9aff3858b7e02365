//! The images behind the errors of a view.

use glam::Vec3;

use super::metrics::Band;

/// The compared images of a view, row by row from the top.
#[derive(Clone, Debug)]
pub struct ViewImages {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Visibility according to the technique, 0 to 1.
    pub visibility: Vec<f32>,
    /// Hard reference, 0 or 1.
    pub truth: Vec<f32>,
    /// Whether each pixel is a receiver.
    pub receivers: Vec<bool>,
    /// The band of pixels near edges, which are counted separately.
    pub band: Band,
}

impl ViewImages {
    /// Returns an image of the errors, four bytes per pixel: grey is the visibility, red is dark but should be lit,
    /// blue is lit but should be dark, both paler in the band; pixels that are not receivers are dimmed.
    #[must_use]
    pub fn errors_rgba8(&self) -> Vec<u8> {
        (0..self.visibility.len()).flat_map(|pixel| self.color(pixel)).collect()
    }

    fn color(&self, pixel: usize) -> [u8; 4] {
        let grey = Vec3::splat(0.15 + 0.6 * self.visibility[pixel]);
        if !self.receivers[pixel] {
            let [grey, ..] = (grey * 80.0).to_array();
            return [grey as u8, grey as u8, grey as u8 + 15, 255];
        }
        let off = self.visibility[pixel] - self.truth[pixel];
        let color = if off < 0.0 { Vec3::new(1.0, 0.0, 0.0) } else { Vec3::new(0.1, 0.2, 1.0) };
        let weight = off.abs() * if self.band.contains(pixel) { 0.45 } else { 1.0 };
        let [red, green, blue] = (grey.lerp(color, weight) * 255.0).to_array();
        [red as u8, green as u8, blue as u8, 255]
    }
}
