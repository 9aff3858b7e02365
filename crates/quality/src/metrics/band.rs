//! The pixels at edges, where a shadow map can be wrong by its resolution alone.

use super::Samples;
use super::distance::squared_distances;
use super::surface::parted;

/// The band's width on either side of an edge, pixels.
pub const BAND_PX: f32 = 2.0;

/// The same in shadow texels as they appear on screen; the wider one counts.
pub const BAND_TEXELS: f32 = 1.5;

/// The pixels at true shadow edges, silhouettes and creases.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Band {
    inside: Vec<bool>,
}

impl Band {
    /// Whether a pixel is in the band; `false` outside the picture.
    #[must_use]
    pub fn contains(&self, pixel: usize) -> bool {
        self.inside.get(pixel).copied().unwrap_or(false)
    }

    /// Adds a pixel of the picture.
    pub fn insert(&mut self, pixel: usize) {
        if let Some(inside) = self.inside.get_mut(pixel) {
            *inside = true;
        }
    }

    /// How many pixels are in it, receivers or not.
    #[must_use]
    pub fn count(&self) -> usize {
        self.inside.iter().filter(|inside| **inside).count()
    }
}

/// Finds the band.
///
/// An edge runs between two 4-neighbours: a true shadow edge where both are receivers and their truths
/// differ, a silhouette or crease where they show different pieces of surface, and the end of everything
/// where only one is drawn. A pixel is in the band if an edge is within [`BAND_PX`] or [`BAND_TEXELS`] times
/// its own `texel_px`, whichever is more, as the Euclidean distance to the nearest pixel at an edge (on
/// either side) plus the half pixel from there to the edge. So a straight edge gets 2 pixels on each side.
///
/// ```text
/// truth   1 1 1 1|0 0 0 0
/// band        # #|# #
/// ```
#[must_use]
pub fn band(samples: &Samples<'_>) -> Band {
    let distances = squared_distances(&at_edges(samples), samples.width);
    let inside = distances.iter().zip(samples.images.texel_px).map(|(&squared_px, &texel_px)| {
        let reach_px = BAND_PX.max(BAND_TEXELS * texel_px) - 0.5;
        squared_px <= reach_px * reach_px
    });
    Band { inside: inside.collect() }
}

/// Marks the pixels on both sides of each edge.
fn at_edges(samples: &Samples<'_>) -> Vec<bool> {
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
    let truth_changes = samples.is_truly_dark(a) != samples.is_truly_dark(b);
    (truth_changes && samples.is_receiver(a) && samples.is_receiver(b)) || parted(samples, a, b)
}
