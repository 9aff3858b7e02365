//! Descriptions of textures and buffers.

use serde::{Deserialize, Serialize};
use std::num::NonZeroU32;
use wgpu_types::{Extent3d, TextureDimension};

/// A texture format, as wgpu names it.
pub type Format = wgpu_types::TextureFormat;
/// A size in texels: width, height, and depth or layers.
pub type Extent = Extent3d;

/// The description of a texture. It has no usage flags, which the graph derives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct TextureDesc {
    /// Size in texels; `depth_or_array_layers` counts layers of a 2D texture.
    pub size: Extent,
    /// Texel format.
    pub format: Format,
    /// Number of mip levels, at least 1.
    pub mip_levels: u32,
    /// Samples per texel: 1, or 4 for multisampling.
    pub samples: u32,
    /// Dimension: 1D, 2D or 3D.
    pub dimension: TextureDimension,
}

impl TextureDesc {
    /// Describes a 2D texture of `width` x `height` texels with one layer, one mip level and one sample.
    ///
    /// ```
    /// use shadowgraph_core::{Format, TextureDesc};
    /// let desc = TextureDesc::d2(256, 128, Format::Depth32Float);
    /// assert_eq!(desc.bytes(), 256 * 128 * 4);
    /// ```
    pub fn d2(width: u32, height: u32, format: Format) -> Self {
        Self {
            size: Extent { width, height, depth_or_array_layers: 1 },
            format,
            mip_levels: 1,
            samples: 1,
            dimension: TextureDimension::D2,
        }
    }

    /// Returns the description with this many samples per texel.
    #[must_use]
    pub fn samples(mut self, samples: u32) -> Self {
        self.samples = samples;
        self
    }

    /// Returns the description with `layers` array layers.
    pub fn layers(mut self, layers: u32) -> Self {
        self.size.depth_or_array_layers = layers;
        self
    }

    /// Returns the memory of the texture in bytes, all mips, layers and samples, without the driver's padding;
    /// `u64::MAX` if it exceeds any memory.
    pub fn bytes(&self) -> u64 {
        if self.texels() > 1 << 48 {
            return u64::MAX;
        }
        let layers = if self.dimension == TextureDimension::D3 { 1 } else { self.size.depth_or_array_layers };
        (0..self.mip_levels.min(32))
            .map(|mip| {
                let mut size = self.size.mip_level_size(mip, self.dimension);
                if self.dimension != TextureDimension::D3 {
                    size.depth_or_array_layers = layers;
                }
                self.format.theoretical_memory_footprint(size)
            })
            .sum::<u64>()
            * u64::from(self.samples)
    }

    /// Returns the samples of the largest mip.
    pub(crate) fn texels(&self) -> u128 {
        let Extent { width, height, depth_or_array_layers } = self.size;
        [height, depth_or_array_layers, self.samples]
            .into_iter()
            .fold(width.into(), |texels: u128, side| texels.saturating_mul(side.into()))
    }
}

/// The description of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct BufferDesc {
    /// Size in bytes, at least 4 and a multiple of 4.
    pub bytes: u64,
    /// Size in bytes of an element, if the buffer is a list to which the GPU appends in any order.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub element_bytes: Option<NonZeroU32>,
}

impl BufferDesc {
    /// Describes a buffer of `bytes` bytes, rounded up to a multiple of 4 for copies.
    pub fn new(bytes: u64) -> Self {
        let bytes = bytes.checked_next_multiple_of(4).unwrap_or(u64::MAX - 3).max(4);
        Self { bytes, element_bytes: None }
    }

    /// Declares that the buffer is a list of elements of this size, to which the GPU appends in any order, such as with an atomic counter.
    /// [`Contained`](crate::Contained) has its elements sorted, so two frames with the same elements are equal.
    #[must_use]
    pub fn unordered(self, element_bytes: u32) -> Self {
        Self { element_bytes: NonZeroU32::new(element_bytes), ..self }
    }
}

/// The description of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum ResourceDesc {
    /// A texture.
    Texture(TextureDesc),
    /// A buffer.
    Buffer(BufferDesc),
}

impl ResourceDesc {
    /// Returns the size in bytes, without the driver's padding.
    pub fn bytes(&self) -> u64 {
        match self {
            Self::Texture(desc) => desc.bytes(),
            Self::Buffer(desc) => desc.bytes,
        }
    }
}
