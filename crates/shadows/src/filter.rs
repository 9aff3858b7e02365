//! The shadow filter: a 5 x 5 tent of nine bilinear comparisons.
//!
//! `pcf.wgsl` has the same weights; the functions here are its twin for tests and tools.

/// How far from the point it is asked for the filter reads, in texels of the map.
pub const FILTER_REACH_TEXELS: f32 = 3.0;

/// The unused border on each side of a tile, pixels: as wide as the filter reaches.
pub const BORDER_PX: u32 = 3;

/// The sum of the filter's weights.
pub const FILTER_SUM: f64 = 144.0;

/// The three bilinear taps of the filter along one axis.
///
/// `fraction` is how far the point is past the centre of the texel it counts from, 0 up to 1. Returns
/// weight and offset, in texels from that centre, of each tap. The weights add up to 12.
///
/// ```
/// use shadowgraph_shadows::filter_taps;
/// let weights: f64 = filter_taps(0.3).iter().map(|(weight, _)| weight).sum();
/// assert!((weights - 12.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn filter_taps(fraction: f64) -> [(f64, f64); 3] {
    let s = fraction;
    let (first, last) = (4.0 - 3.0 * s, 1.0 + 3.0 * s);
    [(first, (3.0 - 2.0 * s) / first - 2.0), (7.0, (3.0 + s) / 7.0), (last, s / last + 2.0)]
}

/// What shared services must know about a technique: how wide it reads, how it moves its lookups, and how far
/// from a receiver it looks for things that block light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Needs {
    /// Texels around the point that the filter reads.
    pub kernel_radius_texels: f32,
    /// The longest way that a lookup is moved sideways in its tile, texels.
    pub bias_texels: f32,
    /// How far beside a receiver a blocker can be and still matter, metres, beyond the kernel.
    pub blocker_reach_m: f32,
}

impl Needs {
    /// The pixels inside each edge of a tile that points must keep away from: filter, bias, and the texel that
    /// snapping can be off.
    #[must_use]
    pub fn margin_px(&self) -> f64 {
        f64::from(self.kernel_radius_texels) + f64::from(self.bias_texels) + 1.0
    }
}
