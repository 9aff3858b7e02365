//! The shadow filter: a tent of bilinear comparisons.
//!
//! `shadows/tent.wgsl` has the same weights; [`filter_taps`] is its twin for tests and tools.

use serde::{Deserialize, Serialize};

/// How shadows' edges are smoothed: by how many texels each way, and by how many bilinear comparisons.
///
/// The weights are those of a tent: each texel counts with the area of a triangle, as wide as the filter and centred at
/// the point, over it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub enum ShadowFilter {
    /// 2 x 2 texels, 1 comparison: the bilinear mix that hardware does. What others call hard shadows.
    Tent2,
    /// 3 x 3 texels, 4 comparisons.
    Tent3,
    /// 5 x 5 texels, 9 comparisons.
    #[default]
    Tent5,
    /// 7 x 7 texels, 16 comparisons.
    Tent7,
}

impl ShadowFilter {
    /// All of them, from hard to soft.
    pub const ALL: [Self; 4] = [Self::Tent2, Self::Tent3, Self::Tent5, Self::Tent7];

    /// Returns how many comparisons it makes along each axis, 1 to 4.
    #[must_use]
    pub fn taps(self) -> u32 {
        match self {
            Self::Tent2 => 1,
            Self::Tent3 => 2,
            Self::Tent5 => 3,
            Self::Tent7 => 4,
        }
    }

    /// Returns how far from the point it is asked for it reads, in texels of the map: 1 to 4. Tiles have a border as wide.
    #[must_use]
    pub fn kernel_radius_texels(self) -> f32 {
        self.taps() as f32
    }

    /// Returns the border on each side of a tile, pixels: as wide as the filter reaches.
    #[must_use]
    pub fn border_px(self) -> u32 {
        self.taps()
    }

    /// Returns half the width of the tent, texels.
    #[must_use]
    pub fn half_width_texels(self) -> f64 {
        match self {
            Self::Tent2 => 1.0,
            _ => f64::from(self.taps()) - 0.5,
        }
    }
}

/// Returns the bilinear taps of a filter along one axis: the weight and the offset of each, in texels.
///
/// `fraction` is how far the point is past the centre of the texel that offsets count from, 0 up to 1. `width` makes the
/// tent narrower, above 0 to 1; it never gets narrower than one texel. Weights add up to 1.
///
/// ```
/// use shadowgraph_shadows::{ShadowFilter, filter_taps};
/// let weights: f64 = filter_taps(ShadowFilter::Tent5, 1.0, 0.3).map(|(weight, _)| weight).sum();
/// assert!((weights - 1.0).abs() < 1e-12);
/// ```
pub fn filter_taps(
    filter: ShadowFilter,
    width: f64,
    fraction: f64,
) -> impl Iterator<Item = (f64, f64)> + Clone {
    let half = (filter.half_width_texels() * width).max(0.5);
    let taps = filter.taps();
    (0..taps).map(move |tap| {
        if taps == 1 {
            return (1.0, fraction);
        }
        // The two texels of the tap lie between these edges.
        let first = f64::from(2 * tap) - f64::from(taps - 1);
        let edge = |i: f64| tent_integral(first - fraction - 0.5 + i, half);
        let (left, right) = (edge(1.0) - edge(0.0), edge(2.0) - edge(1.0));
        let weight = left + right;
        (weight, first + if weight > 0.0 { right / weight } else { 0.5 })
    })
}

/// The area, of 1 in all, of a tent from its left end at `-half` to `x`: 0 to 1.
fn tent_integral(x: f64, half: f64) -> f64 {
    let t = (x / half).clamp(-1.0, 1.0);
    0.5 + t - 0.5 * t * t.abs()
}

/// What shared services must know about a technique: how wide it reads, how it moves its lookups, and how far
/// from a receiver it looks for things that block light.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Requirements {
    /// Texels around the point that the filter reads, 0 to 24: borders of tiles are as wide.
    pub kernel_radius_texels: f32,
    /// The longest way that a lookup is moved sideways in its tile, texels.
    pub bias_texels: f32,
    /// How far beside a receiver a blocker can be and still matter, metres, beyond the kernel: casters that are nearer are drawn.
    pub blocker_reach_m: f32,
    /// Whether passes fit the cascades: each then has all casters that matter to the view, the last one covers the whole view, the
    /// first view that covers a point is read, and no cascade is kept from frame to frame.
    pub fits_on_gpu: bool,
}

impl Requirements {
    /// Those of a technique without maps.
    pub const NONE: Self =
        Self { kernel_radius_texels: 0.0, bias_texels: 0.0, blocker_reach_m: 0.0, fits_on_gpu: false };

    /// The pixels inside each edge of a tile that points must keep away from: filter, bias, and the texel that
    /// snapping can be off.
    #[must_use]
    pub fn margin_px(&self) -> f64 {
        f64::from(self.kernel_radius_texels) + f64::from(self.bias_texels) + 1.0
    }
}
