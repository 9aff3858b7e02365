//! UASTC: blocks of two colours and a place between them for each pixel.

use super::bits::BitWriter;
use super::container::{Content, Texture, check_levels, write};
use super::etc1s;
use super::ramp::{Ramp, fit};
use super::{Block, Image};

/// The layout of a block with two end colours of eight bits per channel.
struct Mode {
    /// The five bits that start the block and name the mode.
    prefix: u32,
    /// Channels of the end colours.
    channels: usize,
    /// The places between the end colours, in 64ths of the way.
    weights: &'static [i32],
}

/// Mode 5: opaque.
const OPAQUE: Mode = Mode { prefix: 0b01011, channels: 3, weights: &[0, 9, 18, 27, 37, 46, 55, 64] };
/// Mode 14: with alpha.
const TRANSLUCENT: Mode = Mode { prefix: 0b01101, channels: 4, weights: &[0, 21, 43, 64] };
/// The five bits that name mode 8: a single colour.
const SOLID_PREFIX: u32 = 0b10111;

/// The correction of ETC1 base colours that changes no channel (one digit of base 3 for each).
const NO_ETC1_BIAS: u32 = 1 + 3 + 9;
/// From the lowest to the highest value of the first table of EAC alpha, at a multiplier of 1.
const EAC_SPAN: u8 = 29;

/// Encodes mip levels (the largest first; each level a quarter of the pixels of the one above) as UASTC
/// without supercompression.
///
/// # Panics
///
/// Panics if the levels are not the first levels of a mip chain.
pub fn uastc(levels: &[Image], srgb: bool) -> Vec<u8> {
    check_levels(levels);
    write(&Texture {
        width: levels[0].width,
        height: levels[0].height,
        srgb,
        content: Content::Uastc { alpha: levels.iter().any(Image::has_alpha) },
        levels: levels
            .iter()
            .map(|level| level.blocks().flat_map(|block| encode(&block)).collect())
            .collect(),
    })
}

/// Returns the 16 bytes of a block.
fn encode(block: &Block) -> Vec<u8> {
    let mut bits = BitWriter::default();
    if block.iter().all(|pixel| *pixel == block[0]) {
        write_solid(&mut bits, block);
    } else if block.iter().all(|pixel| pixel[3] == 255) {
        write_ramp(&mut bits, block, &OPAQUE);
    } else {
        write_ramp(&mut bits, block, &TRANSLUCENT);
    }
    let mut bytes = bits.into_bytes();
    bytes.resize(16, 0);
    bytes
}

/// Writes a block of one colour.
fn write_solid(bits: &mut BitWriter, block: &Block) {
    bits.put(SOLID_PREFIX, 5);
    for channel in block[0] {
        bits.put(u32::from(channel), 8);
    }
    // The rest says how ETC1 stores the colour: in the differential mode, which has five bits per channel.
    let (endpoint, selectors) = etc1s::fit(block);
    let first_selector = selectors[0] & 3;
    bits.put(1, 1);
    bits.put(u32::from(endpoint.table), 3);
    bits.put(u32::from(first_selector), 2);
    for channel in endpoint.colour {
        bits.put(u32::from(channel), 5);
    }
}

/// Writes a block of colours between two others.
fn write_ramp(bits: &mut BitWriter, block: &Block, mode: &Mode) {
    let mut ramp = fit(block, mode.weights);
    let last_weight = mode.weights.len() - 1;
    // The first pixel's weight is stored without its highest bit, which thus has to be zero.
    if ramp.weights[0] > last_weight / 2 {
        ramp = Ramp {
            ends: [ramp.ends[1], ramp.ends[0]],
            weights: ramp.weights.map(|weight| last_weight - weight),
        };
    }

    bits.put(mode.prefix, 5);
    write_hints(bits, block, mode);
    for channel in 0..mode.channels {
        for end in ramp.ends {
            bits.put(u32::from(end[channel]), 8);
        }
    }
    let weight_bits = mode.weights.len().ilog2();
    for (position, &weight) in ramp.weights.iter().enumerate() {
        bits.put(weight as u32, weight_bits - u32::from(position == 0));
    }
}

/// Writes what helps a transcoder to other formats. Plain choices: they cost it quality or time only.
fn write_hints(bits: &mut BitWriter, block: &Block, mode: &Mode) {
    // BC1 takes over neither the end colours nor the weights.
    bits.put(0, 2);
    // ETC1 has a left and a right half, here in the differential mode, which has five bits per channel.
    bits.put(0b10, 2);
    for first_column in [0, 2] {
        bits.put(intensity_table(block, first_column), 3);
    }
    bits.put(NO_ETC1_BIAS, 5);
    if mode.channels == 4 {
        // EAC alpha takes its first table and the multiplier that makes it span the alpha of the block.
        let alpha = || block.iter().map(|pixel| pixel[3]);
        let span = alpha().max().unwrap_or(0) - alpha().min().unwrap_or(0);
        let table = 0;
        bits.put(table, 4);
        bits.put(u32::from(span.div_ceil(EAC_SPAN).max(1)), 4);
    }
}

/// Returns the ETC1 intensity table that reaches about as far from the mean of two columns as their pixels.
fn intensity_table(block: &Block, first_column: usize) -> u32 {
    let columns = first_column..first_column + 2;
    let pixels =
        || (0..16).filter(|position| columns.contains(&(position % 4))).map(|position| block[position]);
    let brightness =
        || pixels().map(|pixel| pixel[..3].iter().map(|&value| i32::from(value)).sum::<i32>() / 3);
    let spread = brightness().max().unwrap_or(0) - brightness().min().unwrap_or(0);
    (0..8).min_by_key(|&table| (etc1s::INTENSITIES[table as usize][3] - spread / 2).abs()).unwrap_or(0)
}
