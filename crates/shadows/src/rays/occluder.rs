//! Occluders: triangles, some of them alpha-tested, some of them translucent.

use glam::{DVec3, Vec2, Vec3, Vec4};

/// Largest absolute coordinate of a valid corner, metres: products of
/// three such numbers still fit into f32.
pub(crate) const MAX_COORDINATE_M: f32 = 1e9;

/// A triangle that blocks light from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// The corners, metres relative to the frame's origin.
    pub corners: [Vec3; 3],
    /// The surface of the triangle.
    pub surface: Surface,
}

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
    /// Index of the alpha channel; `None` for the factor alone.
    pub texture: Option<u32>,
    /// Texture coordinates of each corner: (0, 0) is the first texel's outer corner, (1, 1) the last one's,
    /// with the material's transform applied.
    pub uv: [Vec2; 3],
    /// The material's alpha times the vertex's, at each corner.
    pub alpha: [f32; 3],
    /// Alpha below this is a hole, 0 or more.
    pub cutoff: f32,
}

/// Coloured transmittance: with alpha a and colour c, the light is multiplied by `(1 - a) * mix(1, c, a * (2 - a))`.
///
/// Both are the channels' values times the factor, interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// Index of the first of four channels, alpha and linear red, green and blue; `None` for the factor alone.
    pub texture: Option<u32>,
    /// Texture coordinates of each corner, as in [`Cutout::uv`].
    pub uv: [Vec2; 3],
    /// The material's linear colour and alpha times the vertex's, at each corner. Colours are rounded to 1/255.
    pub color: [Vec4; 3],
}

impl Occluder {
    /// Creates an opaque triangle.
    #[must_use]
    pub fn opaque(corners: [Vec3; 3]) -> Self {
        Self { corners, surface: Surface::Opaque }
    }

    /// Returns whether rays can be tested against it: all numbers finite, corners within 1e9 m, area above 0, no cutoff below 0.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        let near = |corner: &Vec3| corner.is_finite() && corner.abs().max_element() <= MAX_COORDINATE_M;
        self.corners.iter().all(near) && self.has_area() && self.surface.is_valid()
    }

    fn has_area(&self) -> bool {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    }
}

impl Surface {
    fn is_valid(&self) -> bool {
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

    /// Returns the channels that it reads: the first and their number.
    pub(crate) fn channels(&self) -> Option<(u32, u32)> {
        match self {
            Self::Opaque => None,
            Self::Cutout(cut) => Some((cut.texture?, 1)),
            Self::Tint(tint) => Some((tint.texture?, 4)),
        }
    }
}
