//! The bias that keeps surfaces from shadowing themselves.

use crate::declare_settings;

declare_settings! {
    /// The bias that keeps surfaces from shadowing themselves. Lengths are in shadow texels of the tile that is read.
    pub struct BiasSettings {
        /// Depth change that lookups are biased by.
        method: BiasMethod = BiasMethod::Plane;
        /// Distance by which the point is moved along the triangle's normal before it is looked up; see `normal`.
        normal_texels: f32 = 0.25, 0..=4, in "texels";
        /// Scale of the bias along the normal.
        normal: NormalBias = NormalBias::Sine;
        /// Part of the depth change of `method` by which each lookup of the filter is moved towards the light.
        slope: f32 = 1.0, 0..=4, in "times the receiver's slope";
        /// Depth change in every direction that lookups away from the middle allow for at least, only with `Plane`. It keeps the foot of a lit
        /// wall from being darkened by the wall.
        min_slope: f32 = 0.5, 0..=4, in "texels of depth per texel";
        /// Steepest depth change that `slope` follows.
        max_slope: f32 = 10.0, 1..=100, in "texels of depth per texel";
        /// Distance by which every lookup is moved towards the light.
        depth_texels: f32 = 0.25, 0..=16, in "texels";
    }
}

declare_settings! {
    /// The depth change that a lookup is biased by.
    #[derive(Copy, Eq, Hash)]
    #[default(Plane)]
    pub enum BiasMethod {
        /// That of the receiver's plane from the middle of the filter to each of its texels: at `slope` 1 a flat surface
        /// never shadows itself.
        Plane;
        /// The steeper of the receiver's changes over one texel across and down, the same for the whole filter: slope-scale bias of
        /// graphics hardware.
        Slope;
        /// The change of the stored depth around the point, the same for the whole filter: gradient shadow maps (Schueler,
        /// "Eliminating Surface Acne with Gradient Shadow Maps", ShaderX4, 2006).
        Gradient;
    }
}

declare_settings! {
    /// The scale of the bias along the normal.
    #[derive(Copy, Eq, Hash)]
    #[default(Sine)]
    pub enum NormalBias {
        /// The sine of the angle between normal and light: surfaces that face the light need none.
        Sine;
        /// The diagonal of a texel and the filter, whatever the angle: √2 (1 + the filter's radius in texels).
        Filter;
    }
}
