//! What was looked at to find the errors of a view, and pictures of it for people.

use glam::Vec3;

use super::metrics::Band;

/// All that was looked at to find the errors, row by row from the top.
#[derive(Clone, Debug)]
pub struct ViewImages {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// What the technique says, 0 to 1.
    pub visibility: Vec<f32>,
    /// What is true, 0 or 1.
    pub truth: Vec<f32>,
    /// Whether the pixel counts.
    pub receivers: Vec<bool>,
    /// Pixels so near to edges that they are counted apart.
    pub band: Band,
}

impl ViewImages {
    /// Returns a picture of the errors, four bytes a pixel: grey is the visibility, red is dark but truly lit, blue lit
    /// but truly dark, both paler in the band; what does not count is dim.
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
