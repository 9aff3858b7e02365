//! The cascades of directional lights.

use serde::{Deserialize, Serialize};

use super::DepthFormat;
use super::check::{in_range, map_size, setting};
use crate::{Error, ShadowFilter};

/// The cascades of the brightest directional lights that cast shadows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct CascadeSettings {
    /// How many, 0 to 8; 0: every directional light has one tile of the atlas.
    pub count: u32,
    /// How many lights have cascades, 1 to 4, the brightest first. Other directional lights have one tile of the atlas.
    pub lights: u32,
    /// Width of the map that holds them all, pixels, a power of two from 256 to 8192. It is split as often each way as
    /// its tiles need: twice for up to four.
    pub map_size_px: u32,
    /// Whether the map is kept from frame to frame, and a cascade drawn again only when it, its light or its casters change:
    /// while the camera stands still.
    pub cache: bool,
    /// How finely the map stores depth.
    pub depth: DepthFormat,
    /// Where one cascade ends and the next begins.
    pub split: SplitScheme,
    /// By how much of its length a slice of the view reaches into the one before it, 0 to 0.5.
    pub overlap: f32,
    /// What a cascade's tile covers.
    pub fit: CascadeFitting,
    /// How a point finds its cascade.
    pub select: CascadeSelection,
    /// How one cascade goes over into the next.
    pub blend: CascadeBlend,
    /// The outer part of the last cascade, over which its shadows fade out, 0 (none) to 1, in addition to the fade at the
    /// end of the shadow distance.
    pub edge_fade: f32,
    /// How shadows' edges are smoothed.
    pub filter: ShadowFilter,
    /// The width of the filter at the end of the shadow distance, in parts of its width at the camera, 0.2 to 1.
    pub far_filter: f32,
    /// How much farther towards the light depth is told apart than a cascade needs by itself, metres, 0 to 10,000.
    /// Casters beyond that count as being there.
    pub near_offset_m: f32,
    /// What the bias of each cascade is multiplied by, 0 to 16; 1 for those that are left out.
    pub bias_scales: Vec<f32>,
}

/// How the shadow distance is divided among the cascades.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub enum SplitScheme {
    /// Fixed ratios for the number of cascades: 0.25 for two, 0.1 and 0.35 for three, 0.067, 0.2 and 0.467 for four;
    /// equal lengths for others.
    #[default]
    Standard,
    /// The ends of all cascades but the last, as parts of the way from the near plane to the shadow distance:
    /// above 0, rising, below 1.
    Ratios(Vec<f32>),
    /// The ends of all cascades but the last, metres of view depth: above 0, rising. Ends beyond the shadow distance are
    /// moved before it.
    Metres(Vec<f32>),
    /// Each cascade ends this many times as far as the one before it, 1.01 to 100.
    Factor(f32),
    /// The first cascade ends here (metres of view depth, 0.001 to 100,000), and all others the same number of times as
    /// far as the one before them. In small scenes the first ends earlier, so that each is at least twice the last.
    Geometric {
        /// Where the first cascade ends.
        first_m: f32,
    },
    /// As `Geometric` from the near plane on: the texels are as large on screen everywhere, and the first cascades very
    /// short.
    Logarithmic,
    /// Between equal lengths (`lambda` 0) and `Logarithmic` (`lambda` 1): Zhang et al., "Parallel-Split Shadow Maps for
    /// Large-scale Virtual Environments", 2006.
    Practical {
        /// The weight of the logarithmic scheme, 0 to 1.
        lambda: f32,
    },
}

/// What a cascade's tile covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CascadeFitting {
    /// The sphere around its slice of the view: as large wherever the camera looks, and moved in whole texels only, so
    /// shadows stand still.
    #[default]
    Stable,
    /// The box around its slice of the view in the light's axes: finer texels, that change as the camera turns.
    Tight,
}

/// How a point finds its cascade.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum CascadeSelection {
    /// The first whose map covers it: the finest texels that there are.
    #[default]
    Map,
    /// The first whose sphere holds it.
    Sphere,
    /// The one whose slice of view depth it is in.
    Depth,
}

/// How one cascade goes over into the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum CascadeBlend {
    /// At once.
    #[default]
    Hard,
    /// Both are looked up over this outer part of each cascade, 0.001 to 0.5, and mixed.
    Soft(f32),
    /// Over this outer part of each cascade, 0.001 to 0.5, every pixel takes one of the two, by a pattern of noise: the
    /// price of one lookup.
    Dither(f32),
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

impl Default for CascadeSettings {
    fn default() -> Self {
        Self {
            count: 4,
            lights: 1,
            map_size_px: 4096,
            cache: false,
            depth: DepthFormat::default(),
            split: SplitScheme::Practical { lambda: 0.85 },
            overlap: 0.0,
            fit: CascadeFitting::default(),
            select: CascadeSelection::default(),
            blend: CascadeBlend::default(),
            edge_fade: 0.0,
            filter: ShadowFilter::default(),
            far_filter: 1.0,
            near_offset_m: 0.0,
            bias_scales: Vec::new(),
        }
    }
}

impl CascadeSettings {
    /// Returns the part of its length by which a slice reaches into the one before it: what is blended is covered by both.
    #[must_use]
    pub fn slice_overlap(&self) -> f64 {
        f64::from(self.overlap.max(self.blend.fraction()))
    }

    pub(super) fn validate(&self) -> Result<(), Error> {
        if self.count > MAX_CASCADES {
            return Err(setting("cascades.count", self.count, "0 to 8"));
        }
        if !(1..=MAX_CASCADE_LIGHTS).contains(&self.lights) {
            return Err(setting("cascades.lights", self.lights, "1 to 4"));
        }
        map_size("cascades.map_size_px", self.map_size_px)?;
        self.split.validate(self.count)?;
        in_range("cascades.overlap", self.overlap, 0.0, 0.5, "0 to 0.5 (part of a slice's length)")?;
        if self.blend != CascadeBlend::Hard {
            let fraction = self.blend.fraction();
            in_range("cascades.blend", fraction, 0.001, 0.5, "0.001 to 0.5 (outer part of a cascade)")?;
        }
        in_range("cascades.edge_fade", self.edge_fade, 0.0, 1.0, "0 to 1 (outer part of the last cascade)")?;
        in_range("cascades.far_filter", self.far_filter, 0.2, 1.0, "0.2 to 1 (part of the filter's width)")?;
        in_range("cascades.near_offset_m", self.near_offset_m, 0.0, 1e4, "0 to 10000 (metres)")?;
        self.bias_scales
            .iter()
            .try_for_each(|&scale| in_range("cascades.bias_scales", scale, 0.0, 16.0, "each 0 to 16"))
    }
}

impl SplitScheme {
    fn validate(&self, count: u32) -> Result<(), Error> {
        match self {
            Self::Standard | Self::Logarithmic => Ok(()),
            Self::Ratios(ends) if rising(ends, count, 1.0) => Ok(()),
            Self::Ratios(ends) => {
                let allowed = "one ratio fewer than cascades, above 0, rising, below 1";
                Err(setting("cascades.split", format!("{ends:?} for {count} cascades"), allowed))
            }
            Self::Metres(ends) if rising(ends, count, f32::MAX) => Ok(()),
            Self::Metres(ends) => {
                let allowed = "one end fewer than cascades, above 0, rising (metres)";
                Err(setting("cascades.split", format!("{ends:?} for {count} cascades"), allowed))
            }
            Self::Factor(factor) => in_range("cascades.split", *factor, 1.01, 100.0, "1.01 to 100 (factor)"),
            Self::Geometric { first_m } => {
                in_range("cascades.split.first_m", *first_m, 0.001, 1e5, "0.001 to 100000 (metres)")
            }
            Self::Practical { lambda } => {
                in_range("cascades.split.lambda", *lambda, 0.0, 1.0, "0 to 1 (0: equal lengths)")
            }
        }
    }
}

/// Whether there is an end for all cascades but the last, between 0 and `below`, each above the one before.
fn rising(ends: &[f32], count: u32, below: f32) -> bool {
    let rises = ends.windows(2).all(|pair| pair[0] < pair[1]);
    ends.len() + 1 == count.max(1) as usize && rises && ends.iter().all(|end| *end > 0.0 && *end < below)
}
