//! What stops light: triangles, some of them with holes.

use glam::{DVec3, Vec2, Vec3};

/// Corners farther than this from the origin along an axis, metres, are taken for broken ones: products of
/// three such numbers still fit into f32.
pub(crate) const FARTHEST_M: f32 = 1e9;

/// A triangle that stops light from both sides.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Occluder {
    /// Its corners, metres relative to the frame's origin.
    pub corners: [Vec3; 3],
    /// Where it has holes; `None` where it has none.
    pub cut: Option<Cut>,
}

/// Where a triangle has holes: where its alpha is below a cutoff.
///
/// Alpha at a point is the texture's (1 without one) times the factor, both interpolated over the triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cut {
    /// The index of its alpha texture; `None` for the factor alone.
    pub texture: Option<u32>,
    /// Where each corner is in the texture: (0, 0) is the first texel's outer corner, (1, 1) the last one's.
    /// The material's transform is applied already.
    pub uv: [Vec2; 3],
    /// The material's alpha times the vertex's, at each corner.
    pub alpha: [f32; 3],
    /// Alpha below this is a hole.
    pub cutoff: f32,
}

impl Occluder {
    /// A triangle without holes.
    #[must_use]
    pub fn solid(corners: [Vec3; 3]) -> Self {
        Self { corners, cut: None }
    }

    /// Tells whether rays can be tested against it: all numbers finite, corners within 1e9 m, area above 0.
    #[must_use]
    pub fn is_sound(&self) -> bool {
        let near = |corner: &Vec3| corner.is_finite() && corner.abs().max_element() <= FARTHEST_M;
        self.corners.iter().all(near) && self.has_area() && self.cut.is_none_or(|cut| cut.is_finite())
    }

    fn has_area(&self) -> bool {
        let [a, b, c] = self.corners.map(|corner| corner.as_dvec3());
        (b - a).cross(c - a) != DVec3::ZERO
    }
}

impl Cut {
    fn is_finite(&self) -> bool {
        let uv = self.uv.iter().all(|uv| uv.is_finite());
        uv && self.alpha.iter().all(|alpha| alpha.is_finite()) && self.cutoff.is_finite()
    }
}
