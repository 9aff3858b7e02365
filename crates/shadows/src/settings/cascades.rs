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
        /// Cascades of each light. With 0 every directional light has one tile of the atlas.
        count: u32 = 4, 0..=8;
        /// Lights that have cascades, the brightest first. Other directional lights have one tile of the atlas.
        lights: u32 = 1, 1..=4;
        /// Width of the map that holds all cascades. It is split as often each way as its tiles need: twice for up to four.
        map_size_px: u32 = 4096, power_of_two 256..=8192, in "pixels";
        /// Keeps the map from frame to frame, and draws a cascade again only when it, its light or its casters change:
        /// while the camera stands still.
        cache: bool = false;
        /// Format of the map.
        depth: DepthFormat = DepthFormat::Depth32;
        /// Ends of the cascades.
        split: SplitScheme = SplitScheme::Practical { lambda: 0.85 };
        /// Part of its length by which a slice of the view reaches into the one before it.
        overlap: f32 = 0.0, 0..=0.5, in "part of a slice's length";
        /// Volume that a cascade's tile covers.
        fit: CascadeFitting = CascadeFitting::Stable;
        /// Selection of the cascade of a point.
        select: CascadeSelection = CascadeSelection::Map;
        /// Transition from one cascade to the next.
        blend: CascadeBlend = CascadeBlend::Hard;
        /// Outer part of the last cascade over which its shadows fade out, in addition to the fade at the end of the shadow distance.
        edge_fade: f32 = 0.0, 0..=1, in "outer part of the last cascade";
        /// Filter of shadow edges.
        filter: ShadowFilter = ShadowFilter::Tent5;
        /// Width of the filter at the end of the shadow distance, as a part of its width at the camera.
        far_filter: f32 = 1.0, 0.2..=1, in "part of the filter's width";
        /// Distance towards the light by which the depth range is longer than the cascade needs. Casters beyond it are drawn at its end.
        near_offset_m: f32 = 0.0, 0..=10000, in "metres";
        /// Factors of the bias of each cascade; 1 for those that are left out.
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
        /// Ends of all cascades but the last, as parts of the way from the near plane to the shadow distance.
        Ratios(Vec<f32> = vec![0.067, 0.2, 0.467], 0..=1, and "one fewer than cascades, above 0, rising, below 1");
        /// Ends of all cascades but the last, as view depth. Ends beyond the shadow distance are moved before it.
        Metres(Vec<f32> = vec![10.0, 30.0, 90.0], 0..=1000000, in "metres", and "one fewer than cascades, above 0, rising");
        /// Ratio of the end of each cascade to the end of the one before it.
        Factor(f32 = 3.0, 1.01..=100);
        /// The first cascade has a fixed end, and the ratio of ends is the same for all others. In small scenes the first ends earlier, so
        /// that each is at least twice the last.
        Geometric {
            /// View depth at which the first cascade ends.
            first_m: f32 = 10.0, 0.001..=100000, in "metres";
        };
        /// As `Geometric` from the near plane on: the texels are as large on screen everywhere, and the first cascades very
        /// short.
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
        /// The sphere around its slice of the view: of the same size wherever the camera looks, and moved in whole texels only, so
        /// shadows do not shimmer.
        Stable;
        /// The box around its slice of the view in the light's axes: finer texels, which change as the camera turns.
        Tight;
    }
}

declare_settings! {
    /// Selection of the cascade of a point.
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
        /// Both cascades are read over this outer part of each cascade, and mixed.
        Soft(f32 = 0.1, 0.001..=0.5, in "outer part of a cascade");
        /// Over this outer part of each cascade, every pixel reads one of the two, by a pattern of noise: the
        /// cost of one lookup.
        Dither(f32 = 0.1, 0.001..=0.5, in "outer part of a cascade");
    }
}

impl CascadeBlend {
    /// Returns the outer part of a cascade that is blended, 0 to 0.5.
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

impl CascadeSettings {
    /// Returns the part of its length by which a slice reaches into the one before it: both cover the part that is blended.
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
        if rising(ends, self.count, below) {
            return Ok(());
        }
        Err(refused(Self::SETTINGS, name, format!("{ends:?} for {} cascades", self.count)))
    }
}

/// Whether there is an end for all cascades but the last, between 0 and `below`, each above the one before.
fn rising(ends: &[f32], count: u32, below: f32) -> bool {
    let rises = ends.windows(2).all(|pair| pair[0] < pair[1]);
    ends.len() + 1 == count.max(1) as usize && rises && ends.iter().all(|end| *end > 0.0 && *end < below)
}
