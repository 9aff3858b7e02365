//! How a pass touches a resource, and what becomes of the contents.

use serde::{Deserialize, Serialize};
use wgpu_types::{BufferUsages, TextureUsages};

/// One way of touching a texture or buffer. Usage flags follow from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Access {
    /// Colour attachment of this index.
    Color(u32),
    /// Target that the colour attachment of this index is resolved into at the end of the pass.
    Resolve(u32),
    /// Depth(-stencil) attachment, tested and written.
    Depth,
    /// Depth(-stencil) attachment, tested only.
    DepthRead,
    /// Texture sampled or loaded by a shader.
    Sampled,
    /// Storage texture or buffer, read.
    StorageRead,
    /// Storage texture or buffer, written (and read, where the contents are preserved).
    StorageWrite,
    /// Uniform buffer.
    Uniform,
    /// Vertex buffer.
    Vertex,
    /// Index buffer.
    Index,
    /// Arguments of an indirect draw or dispatch.
    Indirect,
    /// Source of a copy.
    CopySource,
    /// Target of a copy or upload.
    CopyTarget,
}

impl Access {
    /// Tells whether the access may change the contents.
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::Color(_) | Self::Resolve(_) | Self::Depth | Self::StorageWrite | Self::CopyTarget
        )
    }

    /// Tells whether the access is an attachment of a render pass, resolve targets among them.
    pub fn is_attachment(self) -> bool {
        matches!(self, Self::Color(_) | Self::Resolve(_) | Self::Depth | Self::DepthRead)
    }

    /// Returns the texture usage that the access needs.
    pub fn texture_usage(self) -> TextureUsages {
        match self {
            Self::Color(_) | Self::Resolve(_) | Self::Depth | Self::DepthRead => {
                TextureUsages::RENDER_ATTACHMENT
            }
            Self::Sampled => TextureUsages::TEXTURE_BINDING,
            Self::StorageRead | Self::StorageWrite => TextureUsages::STORAGE_BINDING,
            Self::CopySource => TextureUsages::COPY_SRC,
            Self::CopyTarget => TextureUsages::COPY_DST,
            Self::Uniform | Self::Vertex | Self::Index | Self::Indirect => TextureUsages::empty(),
        }
    }

    /// Returns the buffer usage that the access needs.
    pub fn buffer_usage(self) -> BufferUsages {
        match self {
            Self::StorageRead | Self::StorageWrite => BufferUsages::STORAGE,
            Self::Uniform => BufferUsages::UNIFORM,
            Self::Vertex => BufferUsages::VERTEX,
            Self::Index => BufferUsages::INDEX,
            Self::Indirect => BufferUsages::INDIRECT,
            Self::CopySource => BufferUsages::COPY_SRC,
            Self::CopyTarget => BufferUsages::COPY_DST,
            Self::Color(_) | Self::Resolve(_) | Self::Depth | Self::DepthRead | Self::Sampled => {
                BufferUsages::empty()
            }
        }
    }

    /// Returns the name of the access, as the dumps print it.
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Color(_) => "color",
            Self::Resolve(_) => "resolve target",
            Self::Depth => "depth",
            Self::DepthRead => "depth test",
            Self::Sampled => "sampled",
            Self::StorageRead => "storage read",
            Self::StorageWrite => "storage write",
            Self::Uniform => "uniform",
            Self::Vertex => "vertex",
            Self::Index => "index",
            Self::Indirect => "indirect",
            Self::CopySource => "copy source",
            Self::CopyTarget => "copy target",
        }
    }
}

impl std::fmt::Display for Access {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.as_str())
    }
}

/// The value an attachment is cleared to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum ClearValue {
    /// Red, green, blue, alpha, in the format's own range.
    Color([f64; 4]),
    /// Depth, 0 to 1. With reversed depth the far plane is 0. Stencil, where there is one, becomes 0.
    Depth(f32),
    /// Depth, 0 to 1, and stencil.
    DepthStencil(f32, u32),
}

/// What a write does with the contents that were there before.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Contents {
    /// The attachment is cleared first, then drawn over. Attachments only.
    Clear(ClearValue),
    /// Every texel or byte is written: what was there does not matter. The graph takes your word for it.
    #[serde(rename = "Cover")]
    Overwrite,
    /// What was there stays where this pass does not write; it must have been defined by an earlier write.
    Preserve,
}

impl Contents {
    /// Clears a colour attachment to `rgba` first.
    pub fn clear_color(rgba: [f64; 4]) -> Self {
        Self::Clear(ClearValue::Color(rgba))
    }

    /// Clears a depth attachment to `depth` (0 to 1) first.
    pub fn clear_depth(depth: f32) -> Self {
        Self::Clear(ClearValue::Depth(depth))
    }

    /// Clears a depth-stencil attachment to `depth` (0 to 1) and `stencil` (0 to 255) first.
    pub fn clear_depth_stencil(depth: f32, stencil: u32) -> Self {
        Self::Clear(ClearValue::DepthStencil(depth, stencil))
    }

    /// Tells whether the write needs the earlier contents.
    pub fn preserves(self) -> bool {
        self == Self::Preserve
    }
}
