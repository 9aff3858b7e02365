//! ETC1S: blocks of a base colour, an intensity table, and a choice of four intensities for each pixel.

use super::basislz::{Slice, compress};
use super::container::{Content, Texture, check_levels, write};
use super::{Block, Image};

/// What each table lets a pixel add to all three channels of the base colour.
pub(super) const INTENSITIES: [[i32; 4]; 8] = [
    [-8, -2, 2, 8],
    [-17, -5, 5, 17],
    [-29, -9, 9, 29],
    [-42, -13, 13, 42],
    [-60, -18, 18, 60],
    [-80, -24, 24, 80],
    [-106, -33, 33, 106],
    [-183, -47, 47, 183],
];

/// The part of a block that its pixels share.
#[derive(Clone, Copy, Default, PartialEq, Eq, Hash)]
pub(super) struct Endpoint {
    /// The base colour, five bits per channel.
    pub colour: [u8; 3],
    /// The intensity table.
    pub table: u8,
}

/// The choices of a block's pixels, from 0 for the darkest to 3 for the brightest: a byte for every row,
/// with two bits for every pixel and the left one lowest.
pub(super) type Selectors = [u8; 4];

/// Encodes mip levels (the largest first; each level a quarter of the pixels of the one above) as ETC1S
/// with BasisLZ. Alpha has separate slices if any pixel of any level is not opaque.
///
/// # Panics
///
/// Panics if the levels are not the first levels of a mip chain, or if their blocks need more than 16128
/// distinct endpoints or selectors, since the codebooks keep every one of them.
pub fn etc1s(levels: &[Image], srgb: bool) -> Vec<u8> {
    check_levels(levels);
    let alpha = levels.iter().any(Image::has_alpha);
    let slices: Vec<Vec<Slice>> = levels
        .iter()
        .map(|level| {
            let colour = slice(level, |pixel| pixel);
            let alpha = alpha.then(|| slice(level, |pixel| [pixel[3]; 4]));
            std::iter::once(colour).chain(alpha).collect()
        })
        .collect();
    let compressed = compress(&slices);
    write(&Texture {
        width: levels[0].width,
        height: levels[0].height,
        srgb,
        content: Content::Etc1s { alpha, global_data: compressed.global_data },
        levels: compressed.levels,
    })
}

/// Returns the slice of a level whose red, green and blue are what a function makes of each pixel.
fn slice(level: &Image, colour: impl Fn([u8; 4]) -> [u8; 4]) -> Slice {
    let blocks = level.blocks().map(|block| fit(&block.map(&colour))).collect();
    Slice { blocks_across: level.blocks_across(), blocks }
}

/// Finds a good endpoint for the red, green and blue of a block, and the selectors that go with it.
pub(super) fn fit(block: &Block) -> (Endpoint, Selectors) {
    let mean: [i32; 3] = std::array::from_fn(|channel| {
        let sum: i32 = block.iter().map(|pixel| i32::from(pixel[channel])).sum();
        (sum + 8) / 16
    });
    let mut best = (Endpoint::default(), Selectors::default());
    let mut least_error = i32::MAX;
    for (table, intensities) in (0..).zip(INTENSITIES) {
        // No table has an intensity of zero, so the base colour of a flat block has to differ from its
        // colour by one of the intensities.
        for shift in intensities.into_iter().chain([0]) {
            let endpoint = Endpoint { colour: mean.map(|value| five_bits(value - shift)), table };
            let (error, selectors) = choose_selectors(block, endpoint);
            if error < least_error {
                least_error = error;
                best = (endpoint, selectors);
            }
        }
    }
    best
}

/// Chooses the best selectors for an endpoint. Returns the sum of the squared errors with them.
fn choose_selectors(block: &Block, endpoint: Endpoint) -> (i32, Selectors) {
    let base = endpoint.colour.map(eight_bits);
    let colours = INTENSITIES[usize::from(endpoint.table)]
        .map(|intensity| base.map(|value| (value + intensity).clamp(0, 255)));
    let mut total_error = 0;
    let mut selectors = Selectors::default();
    for (position, pixel) in block.iter().enumerate() {
        let mut best = (i32::MAX, 0);
        for (selector, colour) in (0..).zip(colours) {
            let mut error = 0;
            for channel in 0..3 {
                error += (colour[channel] - i32::from(pixel[channel])).pow(2);
            }
            best = best.min((error, selector));
        }
        let (error, selector) = best;
        total_error += error;
        selectors[position / 4] |= selector << (position % 4 * 2);
    }
    (total_error, selectors)
}

/// Returns the five bits that stand for the value nearest to the given one.
fn five_bits(value: i32) -> u8 {
    ((value.clamp(0, 255) * 31 + 127) / 255) as u8
}

/// Returns the value from 0 to 255 that five bits stand for.
fn eight_bits(bits: u8) -> i32 {
    i32::from(bits << 3 | bits >> 2)
}
