//! The band of pixels at edges, where the resolution of a shadow map alone causes errors.

use super::samples::{Samples, is_disconnected};

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

/// Returns the squared distance from each pixel's centre to that of the nearest marked pixel, px², exactly;
/// infinite if none is marked. Two passes, each linear in the number of pixels: straight up and down, then
/// the lower envelope of a row's parabolas (Felzenszwalb and Huttenlocher 2012).
pub(super) fn squared_distances(marked: &[bool], width: usize) -> Vec<f32> {
    let width = width.max(1);
    let vertical = vertical_distances(marked, width);
    let mut squared = vec![f32::INFINITY; marked.len()];
    let mut envelope = Vec::with_capacity(width);
    for (row, out) in vertical.chunks_exact(width).zip(squared.chunks_exact_mut(width)) {
        row_distances(row, out, &mut envelope);
    }
    squared
}

/// There is no marked pixel in the column.
const NONE: u32 = u32::MAX;

fn vertical_distances(marked: &[bool], width: usize) -> Vec<u32> {
    let mut distances: Vec<u32> = marked.iter().map(|&marked| if marked { 0 } else { NONE }).collect();
    for at in width..distances.len() {
        distances[at] = distances[at].min(distances[at - width].saturating_add(1));
    }
    for at in (width..distances.len()).rev() {
        distances[at - width] = distances[at - width].min(distances[at].saturating_add(1));
    }
    distances
}

/// The parabola of a column: squared distances to its nearest marked pixel. It is the lowest one from `from` on.
struct Parabola {
    x: f64,
    base: f64,
    from: f64,
}

fn row_distances(vertical: &[u32], out: &mut [f32], envelope: &mut Vec<Parabola>) {
    envelope.clear();
    for (x, &distance) in vertical.iter().enumerate().filter(|(_, distance)| **distance != NONE) {
        let (x, base) = (x as f64, f64::from(distance) * f64::from(distance));
        let mut from = f64::NEG_INFINITY;
        while let Some(last) = envelope.last() {
            from = (base - last.base + x * x - last.x * last.x) / (2.0 * (x - last.x));
            if from > last.from {
                break;
            }
            envelope.pop();
            from = f64::NEG_INFINITY;
        }
        envelope.push(Parabola { x, base, from });
    }
    let mut lowest = envelope.iter().peekable();
    let Some(mut parabola) = lowest.next() else { return };
    for (x, out) in out.iter_mut().enumerate() {
        let x = x as f64;
        while let Some(next) = lowest.next_if(|next| next.from < x) {
            parabola = next;
        }
        *out = ((x - parabola.x) * (x - parabola.x) + parabola.base) as f32;
    }
}
