//! Decoding of KTX2 images with Basis Universal data.

use std::sync::Arc;

use basisu::{DecodeFlags, TargetFormat, Transcoder};

use crate::material::Image;

/// The first bytes of a KTX2 file.
const IDENTIFIER: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
/// Supercompression by Zstandard; 0 is none, 1 BasisLZ.
const ZSTANDARD: u32 = 2;
/// Width and height of a block, pixels, and its bytes in UASTC.
const BLOCK_PX: u32 = 4;
const UASTC_BLOCK_BYTES: u64 = 16;

/// Returns whether bytes are a KTX2 file.
pub(super) fn is_ktx2(bytes: &[u8]) -> bool {
    bytes.starts_with(IDENTIFIER)
}

/// Decodes the largest level of a file, and keeps the file for devices with block-compressed formats. `check_size` is called
/// before memory is allocated.
///
/// # Errors
/// The message says what is wrong with the file, or not supported.
pub(super) fn decode(
    name: &str,
    bytes: &[u8],
    check_size: impl FnOnce(u32, u32) -> Result<(), String>,
) -> Result<Image, String> {
    let (width, height) = check_header(bytes, check_size)?;
    let invalid = |error: basisu::Error| format!("is not a KTX2 file of ETC1S or UASTC: {error:?}");
    let transcoder = Transcoder::new(bytes).map_err(invalid)?;
    if transcoder.is_video() {
        return Err("is a KTX2 video (allowed: one image)".into());
    }
    let rgba8 = transcoder.transcode(0, TargetFormat::Rgba32, DecodeFlags::NONE).map_err(invalid)?;
    Ok(Image { ktx2: Some(Arc::from(bytes)), ..Image::new(name, width, height, rgba8) })
}

/// Checks that the file is a 2D image of ETC1S or UASTC, and that what its header describes lies in it. Returns the width and the
/// height.
fn check_header(
    bytes: &[u8],
    check_size: impl FnOnce(u32, u32) -> Result<(), String>,
) -> Result<(u32, u32), String> {
    let [format, _, width, height, depth, layers, faces, levels] = words(bytes, 12)?;
    let [supercompression, dfd_offset, dfd_length, kvd_offset, kvd_length] = words(bytes, 44)?;
    let [sgd_offset, sgd_length] = longs(bytes, 64)?;
    if format != 0 {
        return Err(format!("is a KTX2 file of vkFormat {format} (allowed: 0, for ETC1S and UASTC)"));
    }
    if depth > 0 || layers > 1 || faces > 1 {
        return Err("is a KTX2 file of several images (allowed: one 2D image)".into());
    }
    if supercompression > ZSTANDARD {
        return Err(format!("is a KTX2 file of supercompression {supercompression} (allowed: 0 to 2)"));
    }
    check_size(width, height)?;
    let most = width.max(height).ilog2() + 1;
    if levels > most {
        return Err(format!("is a KTX2 file with {levels} mip levels (allowed: up to {most})"));
    }
    let parts = [(dfd_offset, dfd_length), (kvd_offset, kvd_length)];
    let parts = parts.map(|(offset, length)| (u64::from(offset), u64::from(length)));
    for (offset, length) in parts.into_iter().chain([(sgd_offset, sgd_length)]) {
        check_range(bytes, offset, length)?;
    }
    for level in 0..levels.max(1) {
        let [offset, length, decompressed] = longs(bytes, 80 + 24 * level as usize)?;
        check_range(bytes, offset, length)?;
        let [across, down] = [width, height].map(|size| u64::from((size >> level).max(1).div_ceil(BLOCK_PX)));
        let expected = across * down * UASTC_BLOCK_BYTES;
        if supercompression == ZSTANDARD && decompressed != expected {
            return Err(format!("has {decompressed} bytes in mip level {level} (allowed: {expected})"));
        }
    }
    Ok((width, height))
}

fn check_range(bytes: &[u8], offset: u64, length: u64) -> Result<(), String> {
    match offset.checked_add(length) {
        Some(end) if end <= bytes.len() as u64 => Ok(()),
        _ => Err(format!("is a truncated KTX2 file: {length} bytes at {offset} of {}", bytes.len())),
    }
}

/// Reads integers of 32 bits.
fn words<const N: usize>(bytes: &[u8], offset: usize) -> Result<[u32; N], String> {
    let mut words = [0; N];
    for (i, word) in words.iter_mut().enumerate() {
        let bytes = bytes.get(offset + 4 * i..).and_then(|bytes| bytes.first_chunk());
        *word = u32::from_le_bytes(*bytes.ok_or("is a truncated KTX2 file")?);
    }
    Ok(words)
}

/// Reads integers of 64 bits.
fn longs<const N: usize>(bytes: &[u8], offset: usize) -> Result<[u64; N], String> {
    let mut longs = [0; N];
    for (i, long) in longs.iter_mut().enumerate() {
        let bytes = bytes.get(offset + 8 * i..).and_then(|bytes| bytes.first_chunk());
        *long = u64::from_le_bytes(*bytes.ok_or("is a truncated KTX2 file")?);
    }
    Ok(longs)
}
