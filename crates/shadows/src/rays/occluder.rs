//! What stops light: triangles, some of them with holes, some of them translucent.

use glam::{DVec3, Vec2, Vec3, Vec4};

/// Corners farther than this from the origin along an axis, metres, are taken for broken ones: products of
/// three such numbers still fit into f32.
pub(crate) const FARTHEST_M: f32 = 1e9;

/// A triangle that is in the way of light from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Its corners, metres relative to the frame's origin.
    pub corners: [Vec3; 3],
    /// What passes it.
    pub surface: Surface,
}

/// What light passes through a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Surface {
    /// None.
    #[default]
    Opaque,
    /// All of it through holes.
    Cut(Cut),
    /// Some of it everywhere.
    Tint(Tint),
}

/// Where a triangle has holes: where its alpha is below a cutoff.
///
/// Alpha at a point is the channel's value (1 without one) times the factor, both interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The index of its alpha channel; `None` for the factor alone.
    pub texture: Option<u32>,
    /// Where each corner is in the texture: (0, 0) is the first texel's outer corner, (1, 1) the last one's.
    /// The material's transform is applied already.
    pub uv: [Vec2; 3],
    /// The material's alpha times the vertex's, at each corner.
    pub alpha: [f32; 3],
    /// Alpha below this is a hole, 0 or more.
    pub cutoff: f32,
}

/// How a triangle colours light: where alpha is a and the colour c, the part `(1 - a) * mix(1, c, a * (2 - a))` of it passes.
///
/// Both are the channels' values times the factor, interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tint {
    /// The first of four channels: alpha, and linear red, green and blue; `None` for the factor alone.
    pub texture: Option<u32>,
    /// Where each corner is in the texture, as in [`Cut::uv`].
    pub uv: [Vec2; 3],
    /// The material's linear colour and alpha times the vertex's, at each corner. Colours are kept to 1/255.
    pub color: [Vec4; 3],
}

impl Occluder {
    /// A triangle that no light passes.
    #[must_use]
    pub fn solid(corners: [Vec3; 3]) -> Self {
        Self { corners, surface: Surface::Opaque }
    }

    /// Tells whether rays can be tested against it: all numbers finite, corners within 1e9 m, area above 0, no cutoff below 0.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let near = |corner: &Vec3| corner.is_finite() && corner.abs().max_element() <= FARTHEST_M;
        self.corners.iter().all(near) && self.has_area() && self.surface.is_sound()
    }

    fn has_area(&self) -> bool {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    }
}

impl Surface {
    fn is_sound(&self) -> bool {
        let finite = |uv: &[Vec2; 3]| uv.iter().all(|uv| uv.is_finite());
        match self {
            Self::Opaque => true,
            Self::Cut(Cut { uv, alpha, cutoff, .. }) => {
                finite(uv)
                    && alpha.iter().all(|alpha| alpha.is_finite())
                    && *cutoff >= 0.0
                    && cutoff.is_finite()
            }
            Self::Tint(Tint { uv, color, .. }) => finite(uv) && color.iter().all(|color| color.is_finite()),
        }
    }

    /// The channels that it reads: the first, and how many.
    pub(crate) fn channels(&self) -> Option<(u32, u32)> {
        match self {
            Self::Opaque => None,
            Self::Cut(cut) => Some((cut.texture?, 1)),
            Self::Tint(tint) => Some((tint.texture?, 4)),
        }
    }
}
