//! The requirements of a technique on shared services.

/// The requirements of a technique on shared services, beyond those of each light's settings.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Requirements {
    /// Radius around the point that the filter reads, texels, 0 to 24: the borders of tiles are as wide.
    pub kernel_radius_texels: f32,
    /// Largest sideways offset of a lookup in its tile, texels.
    pub bias_texels: f32,
    /// Step in which tiles of directional lights move, texels: a power of two up to 32. Where the technique computes a value from several
    /// texels, it is then the value of the same ones while the camera moves.
    pub step_texels: u32,
    /// Largest distance to the side of a receiver at which a blocker still matters, metres, in addition to the kernel:
    /// nearer casters are drawn.
    pub blocker_reach_m: f32,
    /// Whether passes on the GPU fit the cascades: each cascade then draws all casters that matter to the view, the last one
    /// covers the whole view, the first view that covers a point is read, and no cascade is cached.
    pub fits_on_gpu: bool,
}

impl Requirements {
    /// The requirements of a technique without maps, or with no more than the settings' filter.
    pub const NONE: Self = Self {
        kernel_radius_texels: 0.0,
        bias_texels: 0.0,
        step_texels: 1,
        blocker_reach_m: 0.0,
        fits_on_gpu: false,
    };

    /// Returns the margin inside each edge of a tile that points must keep, pixels: filter, bias, and what snapping can be off.
    #[must_use]
    pub fn margin_px(&self) -> f64 {
        f64::from(self.kernel_radius_texels) + f64::from(self.bias_texels) + snapping_px(self.step_texels)
    }
}

/// Returns the distance by which tiles that move in steps can be off, pixels.
pub(crate) fn snapping_px(step_texels: u32) -> f64 {
    0.5 + 0.5 * f64::from(step_texels)
}
