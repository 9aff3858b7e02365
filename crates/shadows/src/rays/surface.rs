//! Surfaces of triangles: opaque, alpha-tested or translucent.

use glam::{Vec2, Vec4};

use super::keys::RayTextureKey;

/// The surface of a triangle: the light that passes through it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Surface {
    /// Blocks all light.
    #[default]
    Opaque,
    /// Lets all light through its holes.
    Cutout(Cutout),
    /// Lets some light through everywhere.
    Tint(Tint),
}

/// An alpha test: a triangle has holes where its alpha is below a cutoff.
///
/// Alpha at a point is the channel's value (1 without one) times the factor, both interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cutout {
    /// The texture, whose first channel is alpha; `None` for the factor alone.
    pub texture: Option<RayTextureKey>,
    /// Texture coordinates of each corner: (0, 0) is the first texel's outer corner, (1, 1) the last one's,
    /// with the material's transform applied.
    pub uv: [Vec2; 3],
    /// The material's alpha times the vertex's, at each corner.
    pub alpha: [f32; 3],
    /// Alpha below this is a hole, 0 or more.
    pub cutoff: f32,
}

/// Coloured transmittance: with alpha a and colour c, the light is multiplied by `(1 - a) * mix(1, c, a * (2 - a))`, or by
/// `(1 - a) * c` if the surface transmits.
///
/// Alpha and colour are the channels' values times the factor, interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// The texture, with four channels: alpha and linear red, green and blue; `None` for the factor alone.
    pub texture: Option<RayTextureKey>,
    /// Texture coordinates of each corner, as in [`Cutout::uv`].
    pub uv: [Vec2; 3],
    /// The material's linear colour and alpha times the vertex's, at each corner. Colours are rounded to 1/255.
    pub color: [Vec4; 3],
    /// Whether light is tinted wholly, as by glass, and not by alpha.
    pub transmits: bool,
}

impl Surface {
    /// Returns whether rays can be tested against it: all numbers finite, no cutoff below 0. Rays pass through others.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let finite = |uv: &[Vec2; 3]| uv.iter().all(|uv| uv.is_finite());
        match self {
            Self::Opaque => true,
            Self::Cutout(Cutout { uv, alpha, cutoff, .. }) => {
                finite(uv)
                    && alpha.iter().all(|alpha| alpha.is_finite())
                    && *cutoff >= 0.0
                    && cutoff.is_finite()
            }
            Self::Tint(Tint { uv, color, .. }) => finite(uv) && color.iter().all(|color| color.is_finite()),
        }
    }

    /// Returns its texture, and the number of channels that it reads.
    pub(crate) fn texture(&self) -> Option<(RayTextureKey, usize)> {
        match self {
            Self::Opaque => None,
            Self::Cutout(cut) => Some((cut.texture?, 1)),
            Self::Tint(tint) => Some((tint.texture?, 4)),
        }
    }
}
