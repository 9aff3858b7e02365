//! Block-compressed textures of KTX2 files (Basis Universal), transcoded to a format of the device.

use basisu::{DecodeFlags, TargetFormat, Transcoder};
use wgpu::{AstcBlock, AstcChannel, Features, TextureFormat};

use super::mips::{Encoding, level_count};
use crate::material::Image;

/// The width and height of a block, pixels.
const BLOCK: u32 = 4;

/// A texture in a block-compressed format with all of its mip levels.
pub(super) struct BlockTexture {
    pub(super) format: TextureFormat,
    /// The blocks of each level, row by row, the largest level first.
    pub(super) levels: Vec<Vec<u8>>,
}

impl BlockTexture {
    /// Transcodes an image from a KTX2 file.
    ///
    /// `None` if the device has no such format, or if the file lacks mip levels, which cannot be computed from blocks.
    pub(super) fn transcode(features: Features, image: &Image, encoding: Encoding) -> Option<Self> {
        let (format, target) = format(features, encoding)?;
        let transcoder = Transcoder::new(image.ktx2.as_ref()?).ok()?;
        let levels = level_count(image.width, image.height);
        let whole_blocks = [image.width, image.height].iter().all(|size| size.is_multiple_of(BLOCK));
        if !whole_blocks || transcoder.level_count() != levels || !transcoder.supports(target) {
            return None;
        }
        let level = |level| transcoder.transcode(level, target, DecodeFlags::NONE).ok();
        Some(Self { format, levels: (0..levels).map(level).collect::<Option<_>>()? })
    }
}

/// Returns the number of bytes in a row of blocks.
pub(super) fn bytes_per_row(width: u32) -> u32 {
    width.div_ceil(BLOCK) * 16
}

/// Returns the size of a level in whole blocks, pixels.
pub(super) fn physical_size(size: u32) -> u32 {
    size.next_multiple_of(BLOCK)
}

/// Returns the best format that the device has: all have 16 bytes for each block.
fn format(features: Features, encoding: Encoding) -> Option<(TextureFormat, TargetFormat)> {
    let srgb = encoding == Encoding::Srgb;
    if features.contains(Features::TEXTURE_COMPRESSION_ASTC) {
        let channel = if srgb { AstcChannel::UnormSrgb } else { AstcChannel::Unorm };
        Some((TextureFormat::Astc { block: AstcBlock::B4x4, channel }, TargetFormat::Astc4x4Rgba))
    } else if features.contains(Features::TEXTURE_COMPRESSION_BC) {
        let format = if srgb { TextureFormat::Bc7RgbaUnormSrgb } else { TextureFormat::Bc7RgbaUnorm };
        Some((format, TargetFormat::Bc7Rgba))
    } else if features.contains(Features::TEXTURE_COMPRESSION_ETC2) {
        let format = if srgb { TextureFormat::Etc2Rgba8UnormSrgb } else { TextureFormat::Etc2Rgba8Unorm };
        Some((format, TargetFormat::Etc2Rgba))
    } else {
        None
    }
}
