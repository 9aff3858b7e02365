//! The records of `rays.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::{Cut, Surface, Tint};

/// The `cut` of a triangle that no light passes.
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

/// The `cutoff` of a triangle without holes that colours light.
pub const TINT: f32 = -1.0;

/// Where light passes through a triangle, 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayCut {
    /// The first corner's place in the texture.
    pub uv_a: Vec2,
    /// The second corner's.
    pub uv_b: Vec2,
    /// The third corner's.
    pub uv_c: Vec2,
    /// The index of its alpha channel, before those of its colour if it has them, or [`NO_TEXTURE`].
    pub texture: u32,
    /// Alpha below this is a hole; [`TINT`].
    pub cutoff: f32,
    /// The alpha factor of each corner.
    pub alpha: Vec3,
    /// Nothing.
    pub unused_alpha: u32,
    /// The colour factor of each corner: red in the lowest byte, green, blue.
    pub color: [u32; 3],
    /// Nothing.
    pub unused_color: u32,
}

/// A channel of a texture, 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTexture {
    /// Its first texel among the texels of all channels.
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
    /// The record of a surface, if light passes it.
    pub(crate) fn new(surface: &Surface) -> Option<Self> {
        let (texture, [uv_a, uv_b, uv_c], alpha, color, cutoff) = match *surface {
            Surface::Opaque => return None,
            Surface::Cut(Cut { texture, uv, alpha, cutoff }) => (texture, uv, alpha, [0; 3], cutoff),
            Surface::Tint(Tint { texture, uv, color }) => {
                (texture, uv, color.map(|color| color.w), color.map(packed), TINT)
            }
        };
        let texture = texture.unwrap_or(NO_TEXTURE);
        let alpha = alpha.into();
        Some(Self { uv_a, uv_b, uv_c, texture, cutoff, alpha, unused_alpha: 0, color, unused_color: 0 })
    }
}

/// A colour in 24 bits.
fn packed(color: Vec4) -> u32 {
    let [red, green, blue] =
        color.truncate().to_array().map(|part| (part.clamp(0.0, 1.0) * 255.0).round() as u32);
    red | green << 8 | blue << 16
}

/// A colour of 24 bits.
pub(crate) fn unpacked(color: u32) -> Vec3 {
    let part = |shift: u32| (color >> shift & 255) as f32 / 255.0;
    Vec3::new(part(0), part(8), part(16))
}
