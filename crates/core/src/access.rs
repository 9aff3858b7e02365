//! Accesses to resources, and what they do with the contents.

use serde::{Deserialize, Serialize};
use wgpu_types::{BufferUsages, TextureUsages};

/// A way to access a texture or buffer. Usage flags are derived from it.
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
    /// Texture that a shader samples or loads.
    Sampled,
    /// Storage texture or buffer, read.
    StorageRead,
    /// Storage texture or buffer, written (and read, if the contents are preserved).
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
    /// Returns whether the access may change the contents.
    pub fn writes(self) -> bool {
        matches!(
            self,
            Self::Color(_) | Self::Resolve(_) | Self::Depth | Self::StorageWrite | Self::CopyTarget
        )
    }

    /// Returns whether the access is an attachment of a render pass or a resolve target.
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
    /// Depth, 0 to 1. With reversed depth the far plane is 0. Stencil, if there is one, is cleared to 0.
    Depth(f32),
    /// Depth, 0 to 1, and stencil.
    DepthStencil(f32, u32),
}

/// Effect of a write on the earlier contents.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub enum Contents {
    /// The attachment is cleared before the pass draws. Attachments only.
    Clear(ClearValue),
    /// Every texel or byte is written, so the earlier contents are not needed. The graph does not check this.
    #[serde(rename = "Cover")]
    Overwrite,
    /// The earlier contents are kept where this pass does not write; an earlier write must have defined them.
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

    /// Returns whether the write needs the earlier contents.
    pub fn preserves(self) -> bool {
        self == Self::Preserve
    }
}
