//! The cascades of directional lights.

use super::DepthFormat;
use super::describe::refused;
use super::filter::ShadowFilter;
use crate::declare_settings;
use crate::error::Error;

declare_settings! {
    /// The cascades of the brightest directional lights that cast shadows.
    #[check(CascadeSettings::check_split)]
    pub struct CascadeSettings {
        /// Cascades of each light; fewer in a small scene, if that gives finer texels. With 0 every directional light has one tile of
        /// the atlas.
        count: u32 = 4, 0..=8;
        /// Lights that have cascades, the brightest first. Other directional lights have one tile of the atlas.
        lights: u32 = 1, 1..=4;
        /// Width of the map that holds all cascades. It is divided into as many tiles per side as needed: two for up to four
        /// tiles.
        map_size_px: u32 = 4096, power_of_two 256..=8192, in "pixels";
        /// Keeps the map from frame to frame and draws only what changed: moving casters are added to the kept depth of static ones.
        /// `sdsm` keeps nothing.
        cache: bool = true;
        /// Format of the map.
        depth: DepthFormat = DepthFormat::Depth32;
        /// View depths at which the cascades end.
        split: SplitScheme = SplitScheme::Practical { lambda: 0.85 };
        /// View depth at which the first cascade begins at the earliest; at most nine tenths of the way to the end of the last. Points in front of
        /// it are looked up in coarser cascades.
        begin_m: f32 = 0.0, 0..=100000, in "metres";
        /// Fraction of a slice's length by which it extends into the previous slice.
        overlap: f32 = 0.0, 0..=0.5, in "fraction of the slice's length";
        /// Volume that a cascade's tile covers.
        fit: CascadeFitting = CascadeFitting::Stable;
        /// Rule that selects the cascade in which a point is looked up.
        select: CascadeSelection = CascadeSelection::Map;
        /// Whether `Depth` compares the ends of all cascades at once in place of one after the other.
        branch_free: bool = false;
        /// Transition from one cascade to the next.
        blend: CascadeBlend = CascadeBlend::Hard;
        /// Outer part of the last cascade over which its shadows fade out, in addition to the fade at the end of the shadow distance; not
        /// if it covers the whole scene.
        edge_fade: f32 = 0.0, 0..=1, in "fraction of the last cascade";
        /// Filter of shadow edges.
        filter: ShadowFilter = ShadowFilter::Tent5;
        /// Width of the filter at the end of the shadow distance, as a fraction of its width at the camera.
        far_filter: f32 = 1.0, 0.2..=1, in "fraction of the filter's width";
        /// Distance by which the depth range is extended towards the light. Casters beyond the range are drawn at its near end.
        near_offset_m: f32 = 0.0, 0..=10000, in "metres";
        /// Factor of the bias for each cascade; 1 for cascades that are left out.
        bias_scales: Vec<f32> = Vec::new(), 0..=16;
    }
}

declare_settings! {
    /// Division of the shadow distance among the cascades.
    #[default(Standard)]
    pub enum SplitScheme {
        /// Fixed ratios for the number of cascades: 0.25 for two, 0.1 and 0.35 for three, 0.067, 0.2 and 0.467 for four;
        /// equal lengths for others.
        Standard;
        /// Ends of all cascades but the last, as fractions of the way from the near plane to the end of the last.
        Ratios(Vec<f32> = vec![0.067, 0.2, 0.467], 0..=1, and "one fewer than cascades, above 0, increasing, below 1");
        /// Ends of all cascades but the last, as view depths. Ends beyond that of the last are moved in front of it.
        Metres(Vec<f32> = vec![10.0, 30.0, 90.0], 0..=1000000, in "metres", and "one fewer than cascades, above 0, increasing");
        /// Ratio of the end of each cascade to that of the previous one.
        Factor(f32 = 3.0, 1.01..=100);
        /// The first cascade has a fixed end, and the ratio of successive ends is constant. In small scenes the first cascade ends
        /// earlier, so that each end is at least twice as far as the previous one.
        Geometric {
            /// View depth at which the first cascade ends.
            first_m: f32 = 10.0, 0.001..=100000, in "metres";
        };
        /// As `Geometric`, starting at the near plane: texels have the same size on screen everywhere, and the first cascades are
        /// very short.
        Logarithmic;
        /// Between equal lengths (`lambda` 0) and `Logarithmic` (`lambda` 1): Zhang et al., "Parallel-Split Shadow Maps for
        /// Large-scale Virtual Environments", 2006.
        Practical {
            /// Weight of the logarithmic scheme.
            lambda: f32 = 0.85, 0..=1;
        };
    }
}

declare_settings! {
    /// The volume that a cascade's tile covers.
    #[derive(Copy, Eq, Hash)]
    #[default(Stable)]
    pub enum CascadeFitting {
        /// The sphere around its slice of the view, or around all receivers if that is smaller. Its size does not depend on the view
        /// direction, and it moves by whole texels only, so shadows do not shimmer.
        Stable;
        /// The box around its slice of the view on the light's axes, as wide and as high as the slice: texels are finer, and not square, but
        /// change as the camera turns.
        Tight;
    }
}

declare_settings! {
    /// The rule that selects the cascade in which a point is looked up.
    #[derive(Copy, Eq, Hash)]
    #[default(Map)]
    pub enum CascadeSelection {
        /// The first cascade whose map covers the point: the finest texels available.
        Map;
        /// The first cascade whose sphere contains the point.
        Sphere;
        /// The cascade whose slice of view depth contains the point.
        Depth;
    }
}

declare_settings! {
    /// Transition from one cascade to the next.
    #[derive(Copy)]
    #[default(Hard)]
    pub enum CascadeBlend {
        /// No blending.
        Hard;
        /// In this outer part of each cascade, both cascades are looked up and mixed.
        Soft(f32 = 0.1, 0.001..=0.5, in "fraction of the cascade");
        /// In this outer part of each cascade, noise selects one of the two cascades for each pixel, at the cost of one lookup.
        Dither(f32 = 0.1, 0.001..=0.5, in "fraction of the cascade");
    }
}

impl CascadeBlend {
    /// Returns the outer fraction of a cascade that is blended, 0 to 0.5.
    #[must_use]
    pub fn fraction(self) -> f32 {
        match self {
            Self::Hard => 0.0,
            Self::Soft(fraction) | Self::Dither(fraction) => fraction,
        }
    }
}

/// The most cascades that a light can have.
pub const MAX_CASCADES: u32 = 8;

/// The most lights that can have cascades.
pub const MAX_CASCADE_LIGHTS: u32 = 4;

impl SplitScheme {
    /// Returns whether the ends of cascades depend on the near plane. Then the first cascade does not end in front of all visible receivers.
    pub(crate) fn is_relative_to_near(&self) -> bool {
        matches!(self, Self::Logarithmic | Self::Practical { .. })
    }
}

impl CascadeSettings {
    /// Returns the fraction of a slice's length by which it extends into the previous slice, at least the blended fraction.
    #[must_use]
    pub fn slice_overlap(&self) -> f64 {
        f64::from(self.overlap.max(self.blend.fraction()))
    }

    fn check_split(&self) -> Result<(), Error> {
        let (ends, below, name) = match &self.split {
            SplitScheme::Ratios(ends) => (ends, 1.0, "split.Ratios"),
            SplitScheme::Metres(ends) => (ends, f32::INFINITY, "split.Metres"),
            _ => return Ok(()),
        };
        if is_increasing(ends, self.count, below) {
            return Ok(());
        }
        Err(refused(Self::SETTINGS, name, format!("{ends:?} for {} cascades", self.count)))
    }
}

/// Returns whether `ends` has an end for each cascade but the last, above 0 and below `below`, in increasing order.
fn is_increasing(ends: &[f32], count: u32, below: f32) -> bool {
    let increases = ends.windows(2).all(|pair| pair[0] < pair[1]);
    ends.len() + 1 == count.max(1) as usize && increases && ends.iter().all(|end| *end > 0.0 && *end < below)
}
