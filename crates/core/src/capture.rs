//! Captured contents of textures and buffers, as plain data.

use crate::handle::{PassId, ResourceId};
use crate::subresource::{Rect, Subresource};

/// The contents of a subresource of a texture after one pass of the frame.
#[derive(Clone, Debug, PartialEq)]
pub struct TextureSnapshot {
    /// The captured texture.
    pub resource: ResourceId,
    /// Version of the texture.
    pub version: u32,
    /// First version in the snapshot: `version`, or an earlier one if passes drew into adjacent rectangles.
    pub since: u32,
    /// Pass that wrote the version; `None` at the end of the frame.
    pub pass: Option<PassId>,
    /// Captured subresource: one layer of one mip.
    pub subresource: Subresource,
    /// Width and height of the subresource in texels.
    pub full_px: [u32; 2],
    /// Texels, or the reason why there are none.
    pub texels: Result<Texels, String>,
    /// Named rectangles.
    pub tiles: Vec<SnapshotTile>,
}

/// Texels of a snapshot, possibly subsampled, in rows from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Texels {
    /// Width and height, at least 1 each.
    pub size_px: [u32; 2],
    /// Number of channels, 1 to 4: red, green, blue, alpha.
    pub channels: u32,
    /// Whether the texels are depth: shown as greys over the range in use, with 0 black.
    pub is_depth: bool,
    /// `width * height * channels` values.
    pub values: TexelValues,
}

/// Values of texels.
#[derive(Clone, Debug, PartialEq)]
pub enum TexelValues {
    /// Displayable values, 0 to 255.
    Bytes(Vec<u8>),
    /// Values of any range.
    Floats(Vec<f32>),
}

/// A named rectangle of a snapshot.
#[derive(Clone, Debug, PartialEq)]
pub struct SnapshotTile {
    /// Rectangle in texels of the texture.
    pub rect: Rect,
    /// Name of the rectangle.
    pub name: String,
}

/// The contents of a part of a texture or buffer: what a pass wrote, or what was there when the frame began.
#[derive(Clone, Debug, PartialEq)]
pub struct Contained {
    /// The pass that wrote it; `None` for an import or a history when the frame begins.
    pub pass: Option<PassId>,
    /// The texture or buffer.
    pub resource: ResourceId,
    /// The version.
    pub version: u32,
    /// The part: of a texture one mip level and one aspect.
    pub part: Subresource,
    /// The bytes, for textures in rows from the top and layer by layer without padding, with the
    /// elements of [unordered](crate::BufferDesc::unordered) buffers sorted, or the reason why there are none.
    pub bytes: Result<Vec<u8>, String>,
}
