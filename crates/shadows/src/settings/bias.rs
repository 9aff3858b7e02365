//! The bias that keeps surfaces from shadowing themselves.

use crate::declare_settings;

declare_settings! {
    /// The bias that keeps surfaces from shadowing themselves. Lengths are in shadow texels of the tile that is read.
    pub struct BiasSettings {
        /// Depth slope that the bias follows.
        method: BiasMethod = BiasMethod::Plane;
        /// Normal bias: distance by which the point is moved along the triangle's normal before the lookup, scaled as `normal` says.
        normal_texels: f32 = 0.25, 0..=4, in "texels";
        /// Scale of the bias along the normal.
        normal: NormalBias = NormalBias::Sine;
        /// Factor of the depth slope of `method`; each tap of the filter is moved towards the light accordingly.
        slope: f32 = 1.0, 0..=4, in "times the receiver's slope";
        /// Minimum depth slope, in every direction, for the bias of taps away from the centre; only with `Plane`. It keeps a lit wall from
        /// darkening the ground at its foot.
        min_slope: f32 = 0.5, 0..=4, in "texels of depth per texel";
        /// Steepest depth slope that is followed.
        max_slope: f32 = 20.0, 1..=100, in "texels of depth per texel";
        /// Constant bias: distance by which every tap is moved towards the light.
        depth_texels: f32 = 0.25, 0..=16, in "texels";
    }
}

declare_settings! {
    /// The depth slope that the bias follows.
    #[derive(Copy, Eq, Hash)]
    #[default(Plane)]
    pub enum BiasMethod {
        /// The slope of the receiver plane, from the centre of the filter to each of its texels: with `slope: 1.0` a flat surface
        /// never shadows itself.
        Plane;
        /// The larger of the receiver plane's depth changes over one texel across and one down, the same for the whole filter: the
        /// slope-scale bias of graphics hardware.
        Slope;
        /// The gradient of the stored depths around the point, the same for the whole filter: gradient shadow maps (Schueler,
        /// "Eliminating Surface Acne with Gradient Shadow Maps", ShaderX4, 2006).
        Gradient;
        /// The slope of the casters, which are pushed away from the light as they are drawn into the map: the slope-scaled depth bias of
        /// graphics hardware. Steep surfaces are pushed as far as their slope says: `max_slope` does not limit it.
        Raster;
    }
}

declare_settings! {
    /// The scale of the bias along the normal.
    #[derive(Copy, Eq, Hash)]
    #[default(Sine)]
    pub enum NormalBias {
        /// The sine of the angle between normal and light: surfaces that face the light need none.
        Sine;
        /// √2 (1 + the filter's radius in texels), whatever the angle: the diagonal of a texel times the width of the filter.
        Filter;
    }
}
