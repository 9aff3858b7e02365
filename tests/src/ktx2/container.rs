//! The KTX2 container.

use std::ops::Range;

use super::Image;

/// The bytes that every file starts with.
const IDENTIFIER: [u8; 12] = *b"\xABKTX 20\xBB\r\n\x1A\n";
/// Size of the identifier, the header and the places of the other parts.
const HEADER_SIZE: usize = 80;
/// Size of an entry of the index of levels.
const LEVEL_ENTRY_SIZE: usize = 24;

/// A compressed texture to put into a file.
pub(super) struct Texture {
    /// Pixels in a row of the largest level.
    pub(super) width: u32,
    /// Rows of the largest level.
    pub(super) height: u32,
    /// Whether the colours are sRGB rather than linear.
    pub(super) srgb: bool,
    /// What the levels are made of.
    pub(super) content: Content,
    /// The bytes of the levels, the largest first.
    pub(super) levels: Vec<Vec<u8>>,
}

/// The kinds of compressed blocks.
pub(super) enum Content {
    /// ETC1S blocks with BasisLZ supercompression.
    Etc1s {
        /// Whether levels have a slice for alpha.
        alpha: bool,
        /// What all levels need for decoding.
        global_data: Vec<u8>,
    },
    /// UASTC blocks.
    Uastc {
        /// Whether the blocks hold alpha.
        alpha: bool,
    },
}

/// Checks that images are the first levels of a mip chain.
///
/// # Panics
///
/// Panics if there is no level, if the bytes of a level do not fit its size, if a level does not have
/// half the width and height of the one above (rounded down, but at least 1), or if levels follow the
/// one of a single pixel.
pub(super) fn check_levels(levels: &[Image]) {
    assert!(!levels.is_empty(), "a texture needs a level");
    for level in levels {
        let (width, height) = (level.width, level.height);
        assert!(width > 0 && height > 0, "a level of {width}x{height} has no pixels");
        let bytes = width as usize * height as usize * 4;
        assert_eq!(level.rgba.len(), bytes, "a level of {width}x{height} has the wrong number of bytes");
    }
    for pair in levels.windows(2) {
        let (above, below) = ((pair[0].width, pair[0].height), (pair[1].width, pair[1].height));
        assert_ne!(above, (1, 1), "a level follows the one of a single pixel");
        let expected = ((above.0 / 2).max(1), (above.1 / 2).max(1));
        assert_eq!(below, expected, "a level is not half as large as the one above");
    }
}

/// Writes a file.
pub(super) fn write(texture: &Texture) -> Vec<u8> {
    let nothing = Vec::new();
    let (scheme, global_data, level_alignment) = match &texture.content {
        // Supercompressed levels follow each other without gaps.
        Content::Etc1s { global_data, .. } => (1, global_data, 1),
        // Other levels start at a multiple of the size of a block.
        Content::Uastc { .. } => (0, &nothing, 16),
    };

    let mut file = vec![0; HEADER_SIZE + LEVEL_ENTRY_SIZE * texture.levels.len()];
    let descriptor = append(&mut file, &data_format_descriptor(texture), 4);
    let global_data = append(&mut file, global_data, 8);
    // The smallest level comes first in the file, so that a reader can show it before the others arrive,
    // but last in the index.
    let smallest_first = texture.levels.iter().rev();
    let places: Vec<_> = smallest_first.map(|level| append(&mut file, level, level_alignment)).collect();

    let mut start = IDENTIFIER.to_vec();
    // No format known to Vulkan, bytes as the unit of endianness, no depth, no layers, one face.
    let level_count = texture.levels.len() as u32;
    for number in [0, 1, texture.width, texture.height, 0, 0, 1, level_count, scheme] {
        start.extend(number.to_le_bytes());
    }
    for number in [descriptor.start, descriptor.len()] {
        start.extend((number as u32).to_le_bytes());
    }
    let no_key_value_data = [0; 8];
    start.extend(no_key_value_data);
    for number in [global_data.start, global_data.len()] {
        start.extend((number as u64).to_le_bytes());
    }
    for place in places.into_iter().rev() {
        // BasisLZ has no size between compressed and decoded.
        let uncompressed = if scheme == 0 { place.len() } else { 0 };
        for number in [place.start, place.len(), uncompressed] {
            start.extend((number as u64).to_le_bytes());
        }
    }
    file[..start.len()].copy_from_slice(&start);
    file
}

/// Appends a part of a file at a multiple of an alignment. Returns its place, which is 0 if it is empty.
fn append(file: &mut Vec<u8>, part: &[u8], alignment: usize) -> Range<usize> {
    if part.is_empty() {
        return 0..0;
    }
    file.resize(file.len().next_multiple_of(alignment), 0);
    let start = file.len();
    file.extend(part);
    start..file.len()
}

/// One sample of a data format descriptor: a part of a block.
struct Sample {
    bit_offset: u32,
    bit_length: u32,
    channel: u32,
}

/// Returns the data format descriptor: a single basic block.
fn data_format_descriptor(texture: &Texture) -> Vec<u8> {
    let (model, bytes_per_block, samples) = match texture.content {
        Content::Etc1s { alpha, .. } => {
            let colour = Sample { bit_offset: 0, bit_length: 64, channel: 0 };
            let alpha = alpha.then_some(Sample { bit_offset: 64, bit_length: 64, channel: 15 });
            // Supercompression makes the size of a block unknown.
            (163, 0, std::iter::once(colour).chain(alpha).collect())
        }
        Content::Uastc { alpha } => {
            let channel = if alpha { 3 } else { 0 };
            (166, 16, vec![Sample { bit_offset: 0, bit_length: 128, channel }])
        }
    };
    // Data that is no colour, such as normals, has no primaries; glTF requires that. The others have
    // those of BT.709.
    let (primaries, transfer) = if texture.srgb { (1, 2) } else { (0, 1) };
    let block_size = 24 + 16 * samples.len() as u32;
    let version = 2;
    let mut words: Vec<u32> = vec![
        4 + block_size,
        // The Khronos basic descriptor.
        0,
        version | block_size << 16,
        // No flags: alpha is not premultiplied.
        model | primaries << 8 | transfer << 16,
        // A block has 4x4 pixels; each size is stored less one.
        0x0303,
        bytes_per_block,
        0,
    ];
    for sample in samples {
        let bit_length = sample.bit_length - 1;
        // The sample has no position within the block, and its values span the whole range.
        words.extend([sample.bit_offset | bit_length << 16 | sample.channel << 24, 0, 0, u32::MAX]);
    }
    words.into_iter().flat_map(u32::to_le_bytes).collect()
}
