//! The band of pixels at edges, where the resolution of a shadow map alone causes errors.

use super::Samples;
use super::distance::squared_distances;
use super::surface::is_disconnected;

/// The band's width on either side of an edge, pixels.
pub const BAND_PX: f32 = 2.0;

/// The same in shadow texels as projected on screen; the larger width counts.
pub const BAND_TEXELS: f32 = 1.5;

/// The pixels at true shadow edges, silhouettes and creases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Band {
    inside: Vec<bool>,
}

impl Band {
    /// Returns whether a pixel is in the band; `false` outside the image.
    #[must_use]
    pub fn contains(&self, pixel: usize) -> bool {
        self.inside.get(pixel).copied().unwrap_or(false)
    }

    /// Adds a pixel of the image.
    pub fn insert(&mut self, pixel: usize) {
        if let Some(inside) = self.inside.get_mut(pixel) {
            *inside = true;
        }
    }

    /// Returns the number of pixels in the band, receivers or not.
    #[must_use]
    pub fn count(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }
}

/// Finds the band.
///
/// An edge runs between two 4-neighbours: a true shadow edge where both are receivers and their truths
/// differ, a silhouette or crease where they are disconnected, or the border of the geometry
/// where only one of them has any. A pixel is in the band if an edge is within [`BAND_PX`] or [`BAND_TEXELS`] times
/// its own `texel_px`, whichever is larger, as the Euclidean distance to the nearest pixel at an edge (on
/// either side) plus the half pixel from there to the edge. So a straight edge gets 2 pixels on each side.
///
/// ```text
/// truth   1 1 1 1|0 0 0 0
/// band        # #|# #
/// ```
#[must_use]
pub fn band(samples: &Samples<'_>) -> Band {
    let distances = squared_distances(&edge_mask(samples), samples.width);
    let inside = distances.iter().zip(samples.images.texel_px).map(|(&squared_px, &texel_px)| {
        let reach_px = BAND_PX.max(BAND_TEXELS * texel_px) - 0.5;
        squared_px <= reach_px * reach_px
    });
    Band { inside: inside.collect() }
}

/// Returns a mask of the pixels on both sides of each edge.
fn edge_mask(samples: &Samples<'_>) -> Vec<bool> {
    let mut marked = vec![false; samples.len()];
    let mut mark = |pixel: usize, next: usize| {
        if is_edge(samples, pixel, next) {
            marked[pixel] = true;
            marked[next] = true;
        }
    };
    for y in 0..samples.height {
        for pixel in y * samples.width..(y + 1) * samples.width {
            if pixel + 1 < (y + 1) * samples.width {
                mark(pixel, pixel + 1);
            }
            if y + 1 < samples.height {
                mark(pixel, pixel + samples.width);
            }
        }
    }
    marked
}

fn is_edge(samples: &Samples<'_>, a: usize, b: usize) -> bool {
    let truth_changes = samples.should_be_dark(a) != samples.should_be_dark(b);
    (truth_changes && samples.is_receiver(a) && samples.is_receiver(b)) || is_disconnected(samples, a, b)
}
