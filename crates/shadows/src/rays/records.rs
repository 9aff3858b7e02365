//! The records of `rays.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use super::Cut;

/// The `cut` of a triangle without holes.
pub const NO_CUT: u32 = u32::MAX;

/// The `texture` of a cut without one.
pub const NO_TEXTURE: u32 = u32::MAX;

/// A box of the tree, 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayNode {
    /// Its lowest corner, metres.
    pub lowest: Vec3,
    /// The first of its triangles, or of the two boxes inside it.
    pub first: u32,
    /// Its highest corner, metres.
    pub highest: Vec3,
    /// How many triangles it has; 0: it has boxes.
    pub count: u32,
}

/// A triangle, 48 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTriangle {
    /// Its first corner, metres.
    pub a: Vec3,
    /// The index of its cut, or [`NO_CUT`].
    pub cut: u32,
    /// Its second corner, metres.
    pub b: Vec3,
    /// Nothing.
    pub unused_b: u32,
    /// Its third corner, metres.
    pub c: Vec3,
    /// Nothing.
    pub unused_c: u32,
}

/// Where a triangle has holes, 48 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayCut {
    /// The first corner's place in the texture.
    pub uv_a: Vec2,
    /// The second corner's.
    pub uv_b: Vec2,
    /// The third corner's.
    pub uv_c: Vec2,
    /// The index of its alpha texture, or [`NO_TEXTURE`].
    pub texture: u32,
    /// Alpha below this is a hole.
    pub cutoff: f32,
    /// The alpha factor of each corner.
    pub alpha: Vec3,
    /// Nothing.
    pub unused: u32,
}

/// An alpha texture, 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RayAlphaTexture {
    /// Its first texel among the texels of all textures.
    pub first_texel: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Bits 0 and 1: [`Wrap`](super::Wrap) along u; 2 and 3: along v; 4: [`Filter`](super::Filter).
    pub sampling: u32,
}

impl RayTriangle {
    pub(crate) fn new([a, b, c]: [Vec3; 3], cut: u32) -> Self {
        Self { a, cut, b, unused_b: 0, c, unused_c: 0 }
    }

    /// Its corners, metres relative to the frame's origin.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 3] {
        [self.a, self.b, self.c]
    }
}

impl RayCut {
    pub(crate) fn new(cut: &Cut) -> Self {
        let [uv_a, uv_b, uv_c] = cut.uv;
        let texture = cut.texture.unwrap_or(NO_TEXTURE);
        Self { uv_a, uv_b, uv_c, texture, cutoff: cut.cutoff, alpha: cut.alpha.into(), unused: 0 }
    }
}
