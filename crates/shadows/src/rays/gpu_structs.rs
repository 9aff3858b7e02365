//! The structs of `rays.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

use super::{Cutout, Surface, Tint};

/// [`RayTriangle::material`] of an opaque triangle.
pub const NO_MATERIAL: u32 = u32::MAX;

/// [`RayMaterial::texture`] of a material without a texture.
pub const NO_TEXTURE: u32 = u32::MAX;

/// A node of the tree, 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayNode {
    /// The lowest corner of its box, metres.
    pub lowest: Vec3,
    /// Index of the first of its triangles, or of its two child nodes.
    pub first: u32,
    /// The highest corner of its box, metres.
    pub highest: Vec3,
    /// Number of triangles; 0 for a node with children.
    pub count: u32,
}

/// A triangle, 48 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTriangle {
    /// The first corner, metres.
    pub a: Vec3,
    /// Index of its material, or [`NO_MATERIAL`].
    pub material: u32,
    /// The second corner, metres.
    pub b: Vec3,
    /// Padding.
    pub unused_b: u32,
    /// The third corner, metres.
    pub c: Vec3,
    /// Padding.
    pub unused_c: u32,
}

/// [`RayMaterial::cutoff`] of a translucent material.
pub const TINT: f32 = -1.0;

/// The material of a triangle that is not opaque, 64 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayMaterial {
    /// Texture coordinates of the first corner.
    pub uv_a: Vec2,
    /// Texture coordinates of the second corner.
    pub uv_b: Vec2,
    /// Texture coordinates of the third corner.
    pub uv_c: Vec2,
    /// Index of the alpha channel, which the colour channels follow if there are any, or [`NO_TEXTURE`].
    pub texture: u32,
    /// Alpha below this is a hole; [`TINT`] for a translucent material.
    pub cutoff: f32,
    /// Alpha factor of each corner.
    pub alpha: Vec3,
    /// Padding.
    pub unused_alpha: u32,
    /// Colour factor of each corner: red in the lowest byte, then green and blue.
    pub color: [u32; 3],
    /// Padding.
    pub unused_color: u32,
}

/// A channel of a texture, 16 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTexture {
    /// Index of its first texel among the texels of all channels.
    pub first_texel: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Bits 0 and 1: [`Wrap`](super::Wrap) along u; 2 and 3: along v; 4: [`Filter`](super::Filter).
    pub sampling: u32,
}

impl RayTriangle {
    pub(crate) fn new([a, b, c]: [Vec3; 3], material: u32) -> Self {
        Self { a, material, b, unused_b: 0, c, unused_c: 0 }
    }

    /// Returns the corners, metres relative to the frame's origin.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 3] {
        [self.a, self.b, self.c]
    }
}

impl RayMaterial {
    /// Creates the material of a surface; `None` if it is opaque.
    pub(crate) fn new(surface: &Surface) -> Option<Self> {
        let (texture, [uv_a, uv_b, uv_c], alpha, color, cutoff) = match *surface {
            Surface::Opaque => return None,
            Surface::Cutout(Cutout { texture, uv, alpha, cutoff }) => (texture, uv, alpha, [0; 3], cutoff),
            Surface::Tint(Tint { texture, uv, color }) => {
                (texture, uv, color.map(|color| color.w), color.map(packed), TINT)
            }
        };
        let texture = texture.unwrap_or(NO_TEXTURE);
        let alpha = alpha.into();
        Some(Self { uv_a, uv_b, uv_c, texture, cutoff, alpha, unused_alpha: 0, color, unused_color: 0 })
    }
}

/// Packs a colour into 24 bits.
fn packed(color: Vec4) -> u32 {
    let [red, green, blue] =
        color.truncate().to_array().map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u32);
    red | green << 8 | blue << 16
}

/// Unpacks a colour of 24 bits.
pub(crate) fn unpacked(color: u32) -> Vec3 {
    let channel = |shift: u32| (color >> shift & 255) as f32 / 255.0;
    Vec3::new(channel(0), channel(8), channel(16))
}
