//! The shadow filter: a tent of bilinear comparisons.
//!
//! `shadows/tent.wgsl` has the same weights; [`filter_taps`] is its reference implementation for tests and tools.

use crate::declare_settings;

declare_settings! {
    /// The filter that smooths the edges of shadows: its width in texels and its number of bilinear comparisons.
    ///
    /// The weights are those of a tent: each texel counts with the area over it of a triangle that is centred at the point and
    /// as wide as the filter.
    #[derive(Copy, Eq, PartialOrd, Ord, Hash)]
    #[default(Tent5)]
    pub enum ShadowFilter {
        /// 2 x 2 texels, 1 comparison: the hardware's bilinear filter, usually called hard shadows.
        Tent2;
        /// 3 x 3 texels, 4 comparisons.
        Tent3;
        /// 5 x 5 texels, 9 comparisons.
        Tent5;
        /// 7 x 7 texels, 16 comparisons.
        Tent7;
    }
}

impl ShadowFilter {
    /// All filters, from hard to soft.
    pub const ALL: [Self; 4] = [Self::Tent2, Self::Tent3, Self::Tent5, Self::Tent7];

    /// Returns the number of comparisons along each axis, 1 to 4.
    #[must_use]
    pub fn taps(self) -> u32 {
        match self {
            Self::Tent2 => 1,
            Self::Tent3 => 2,
            Self::Tent5 => 3,
            Self::Tent7 => 4,
        }
    }

    /// Returns the radius that it reads around a point, texels of the map, 1 to 4. The borders of tiles are at least as wide.
    #[must_use]
    pub fn kernel_radius_texels(self) -> f32 {
        self.taps() as f32
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
/// `fraction` is the distance of the point past the centre of the texel that offsets count from, 0 up to 1. `width` scales
/// the tent, above 0 to 1; it never gets narrower than one texel. The weights add up to 1.
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

/// Returns the area of a tent from its left end at `-half` to `x`, relative to the whole: 0 to 1.
fn tent_integral(x: f64, half: f64) -> f64 {
    let t = (x / half).clamp(-1.0, 1.0);
    0.5 + t - 0.5 * t * t.abs()
}
