//! The structs of `rays.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Mat3, Vec2, Vec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;

use super::{Cutout, Surface, Tint};

/// [`RayInstance::first_surface`] of an opaque instance, and [`RaySurface::texture`] of a surface without a texture.
pub const RAY_NONE: u32 = u32::MAX;

/// The bit of [`RayNode::first`] that marks the index of an instance.
pub const RAY_INSTANCE: u32 = 1 << 31;

/// A node of a tree, 32 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayNode {
    /// The lowest corner of its box, metres, relative to the frame's origin or in the space of its mesh.
    pub lowest: Vec3,
    /// Index of the first of its triangles, of the first of its two child nodes, or of its instance with [`RAY_INSTANCE`]; 0 if there is
    /// nothing in it.
    pub first: u32,
    /// The highest corner of its box.
    pub highest: Vec3,
    /// Number of triangles; 0 for a node with children or an instance.
    pub count: u32,
}

/// A triangle of a mesh, 48 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTriangle {
    /// The first corner, in the space of the mesh.
    pub a: Vec3,
    /// Its index among the triangles of the mesh as they were given.
    pub index: u32,
    /// The second corner.
    pub b: Vec3,
    /// Padding.
    pub unused_b: u32,
    /// The third corner.
    pub c: Vec3,
    /// Padding.
    pub unused_c: u32,
}

/// A mesh in the world, 128 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RayInstance {
    /// Rows of the affine matrix `world_from_mesh`; the world is relative to the frame's origin.
    pub world_from_mesh: [Vec4; 3],
    /// Rows of the affine matrix `mesh_from_world`; zero if there is no inverse.
    pub mesh_from_world: [Vec4; 3],
    /// Margin around the boxes of the mesh, per metre of the ray's and the scene's coordinates.
    pub margin: Vec3,
    /// Index of the root of the mesh's tree.
    pub root: u32,
    /// Index of the surface of the mesh's triangle 0, or [`RAY_NONE`].
    pub first_surface: u32,
    /// Padding.
    pub unused: [u32; 3],
}

/// [`RaySurface::cutoff`] of a translucent surface.
pub const TINT: f32 = -1.0;

/// The surface of a triangle of an instance that is not opaque, 64 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct RaySurface {
    /// Texture coordinates of the first corner.
    pub uv_a: Vec2,
    /// Texture coordinates of the second corner.
    pub uv_b: Vec2,
    /// Texture coordinates of the third corner.
    pub uv_c: Vec2,
    /// Index of the first word of the texture, or [`RAY_NONE`].
    pub texture: u32,
    /// Alpha below this is a hole; [`TINT`] for a translucent surface.
    pub cutoff: f32,
    /// Alpha factor of each corner.
    pub alpha: Vec3,
    /// Whether a translucent surface tints light wholly, not by alpha: 0 or 1.
    pub transmits: u32,
    /// Colour factor of each corner: red in the lowest byte, then green and blue.
    pub color: [u32; 3],
    /// Padding.
    pub unused_color: u32,
}

/// Four words that describe a channel of a texture. A texture begins with those of its channels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct RayTexture {
    /// Index of its first texel: four times the word's index, plus the byte in the word.
    pub first_texel: u32,
    /// Number of columns.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Bits 0 and 1: [`Wrap`](super::Wrap) along u; 2 and 3: along v; 4: [`Filter`](super::Filter).
    pub sampling: u32,
}

impl RayNode {
    pub(crate) fn new(bounds: &Aabb, first: u32, count: u32) -> Self {
        Self { lowest: bounds.min.into(), first, highest: bounds.max.into(), count }
    }

    pub(crate) fn bounds(&self) -> Aabb {
        Aabb { min: self.lowest.into(), max: self.highest.into() }
    }

    /// Returns whether it is the leaf of an instance.
    pub(crate) fn is_instance(&self) -> bool {
        self.first & RAY_INSTANCE != 0
    }
}

impl RayTriangle {
    pub(crate) fn new([a, b, c]: [Vec3; 3], index: u32) -> Self {
        Self { a, index, b, unused_b: 0, c, unused_c: 0 }
    }

    /// Returns the corners, in the space of the mesh.
    #[must_use]
    pub fn corners(&self) -> [Vec3; 3] {
        [self.a, self.b, self.c]
    }

    pub(crate) fn bounds(&self) -> Aabb {
        let [a, b, c] = self.corners().map(Vec3A::from);
        Aabb { min: a.min(b).min(c), max: a.max(b).max(c) }
    }
}

impl RayInstance {
    /// Returns the corners of a triangle in the world, by the arithmetic of `draw.wgsl`: metres relative to the frame's origin.
    #[must_use]
    pub fn corners(&self, triangle: &RayTriangle) -> [Vec3; 3] {
        triangle.corners().map(|corner| transformed(&self.world_from_mesh, corner))
    }
}

/// Returns a point transformed by the rows of a matrix.
pub(crate) fn transformed(rows: &[Vec4; 3], point: Vec3) -> Vec3 {
    let point = point.extend(1.0);
    Vec3::from(rows.map(|row| row.dot(point)))
}

/// Returns the rows of a matrix.
pub(crate) fn rows(matrix: &Affine3A) -> [Vec4; 3] {
    let linear = Mat3::from(matrix.matrix3).transpose();
    let [x, y, z] = matrix.translation.to_array();
    [linear.x_axis.extend(x), linear.y_axis.extend(y), linear.z_axis.extend(z)]
}

impl RaySurface {
    /// Creates a surface. `texture` is the first word of its texture.
    pub(crate) fn new(surface: &Surface, texture: Option<u32>) -> Self {
        let open = Self { texture: RAY_NONE, ..Self::default() };
        let texture = texture.unwrap_or(RAY_NONE);
        match *surface {
            _ if !surface.is_valid() => Self { cutoff: f32::MAX, ..open },
            Surface::Opaque => Self { alpha: Vec3::ONE, ..open },
            Surface::Cutout(Cutout { uv: [uv_a, uv_b, uv_c], alpha, cutoff, .. }) => {
                Self { uv_a, uv_b, uv_c, texture, cutoff, alpha: alpha.into(), ..open }
            }
            Surface::Tint(Tint { uv: [uv_a, uv_b, uv_c], color, transmits, .. }) => {
                let (alpha, transmits) = (color.map(|color| color.w).into(), transmits.into());
                let color = color.map(packed);
                Self { uv_a, uv_b, uv_c, texture, cutoff: TINT, alpha, transmits, color, ..open }
            }
        }
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
