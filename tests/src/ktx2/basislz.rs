//! BasisLZ: the codebooks of all ETC1S blocks of a texture, and slices of blocks that refer to them.

use std::collections::HashMap;
use std::hash::Hash;

use super::bits::BitWriter;
use super::etc1s::{Endpoint, Selectors};
use super::huffman::{Code, MAX_SYMBOLS, Symbol, codes, write_symbols};

/// The code of the predictions of endpoints, one symbol for a square of 2x2 blocks.
const PREDICTION: usize = 0;
/// The code of the steps from the endpoint of one block to that of the next.
const STEP: usize = 1;
/// The code of the selectors.
const SELECTOR: usize = 2;
/// The prediction that none of the four blocks takes its endpoint from a neighbour: two bits for each.
const NO_PREDICTION: usize = 0b11_11_11_11;
/// Size of the decoder's memory of selectors. Nothing here refers to it, but it must not be zero.
const SELECTOR_HISTORY_SIZE: u32 = 1;
/// The code of the intensity tables in the endpoint codebook; the ones before it are of the colours.
const TABLE: usize = 3;

/// The blocks of the colour or of the alpha of one level.
pub(super) struct Slice {
    /// The number of blocks in a row.
    pub(super) blocks_across: usize,
    /// The blocks, rows from the top.
    pub(super) blocks: Vec<(Endpoint, Selectors)>,
}

/// A compressed texture.
pub(super) struct Compressed {
    /// What the container keeps as global data: codebooks, code tables and where the slices lie.
    pub(super) global_data: Vec<u8>,
    /// The slices of each level.
    pub(super) levels: Vec<Vec<u8>>,
}

/// Compresses levels, each with a colour slice and possibly an alpha slice.
///
/// # Panics
///
/// Panics if the blocks have more distinct endpoints or selectors than a codebook holds.
pub(super) fn compress(levels: &[Vec<Slice>]) -> Compressed {
    let blocks = || levels.iter().flatten().flat_map(|slice| &slice.blocks);
    let endpoints = Codebook::new("endpoints", blocks().map(|block| block.0));
    let selectors = Codebook::new("selectors", blocks().map(|block| block.1));

    let slices = levels.iter().flatten();
    let streams: Vec<_> = slices.map(|slice| slice_symbols(slice, &endpoints, &selectors)).collect();
    let codes: [Code; 3] = codes(&streams);

    let mut descriptions = Vec::new();
    let mut level_data = Vec::new();
    let mut streams = streams.iter();
    for level in levels {
        let slices: Vec<Vec<u8>> =
            streams.by_ref().take(level.len()).map(|symbols| slice_bytes(symbols, &codes)).collect();
        let colour_length = slices[0].len();
        let alpha = slices.get(1).map_or([0, 0], |alpha| [colour_length, alpha.len()]);
        // The first word has flags, which only frames of a video set.
        descriptions.extend(words([0, 0, colour_length, alpha[0], alpha[1]]));
        level_data.push(slices.concat());
    }

    let endpoint_data = endpoint_codebook(&endpoints.entries);
    let selector_data = selector_codebook(&selectors.entries);
    let tables = code_tables(&codes);
    let mut global_data = Vec::new();
    global_data.extend((endpoints.entries.len() as u16).to_le_bytes());
    global_data.extend((selectors.entries.len() as u16).to_le_bytes());
    // The last word is the length of an extension that ETC1S does not have.
    global_data.extend(words([endpoint_data.len(), selector_data.len(), tables.len(), 0]));
    global_data.extend([descriptions, endpoint_data, selector_data, tables].concat());
    Compressed { global_data, levels: level_data }
}

/// Distinct values in the order in which they first occur.
struct Codebook<T> {
    entries: Vec<T>,
    positions: HashMap<T, usize>,
}

impl<T: Copy + Eq + Hash> Codebook<T> {
    /// Collects the distinct values.
    ///
    /// # Panics
    ///
    /// Panics if there are more than the decoder takes.
    fn new(name: &str, values: impl Iterator<Item = T>) -> Self {
        let mut entries = Vec::new();
        let mut positions = HashMap::new();
        for value in values {
            positions.entry(value).or_insert_with(|| {
                entries.push(value);
                entries.len() - 1
            });
        }
        let count = entries.len();
        assert!(count <= MAX_SYMBOLS, "{count} distinct {name}, and a codebook holds {MAX_SYMBOLS}");
        Self { entries, positions }
    }
}

/// Returns the symbols of the blocks of a slice.
fn slice_symbols(
    slice: &Slice,
    endpoints: &Codebook<Endpoint>,
    selectors: &Codebook<Selectors>,
) -> Vec<Symbol> {
    let count = endpoints.entries.len();
    let mut symbols = Vec::new();
    let mut previous = 0;
    for (position, (endpoint, block_selectors)) in slice.blocks.iter().enumerate() {
        let (column, row) = (position % slice.blocks_across, position / slice.blocks_across);
        if column % 2 == 0 && row % 2 == 0 {
            symbols.push(Symbol { code: PREDICTION, value: NO_PREDICTION });
        }
        let entry = endpoints.positions[endpoint];
        symbols.push(Symbol { code: STEP, value: (entry + count - previous) % count });
        previous = entry;
        symbols.push(Symbol { code: SELECTOR, value: selectors.positions[block_selectors] });
    }
    symbols
}

/// Returns the bytes of a slice.
fn slice_bytes(symbols: &[Symbol], codes: &[Code]) -> Vec<u8> {
    let mut bits = BitWriter::default();
    write_symbols(&mut bits, codes, symbols);
    bits.into_bytes()
}

/// Returns the bytes of the endpoint codebook: every entry as its difference from the one before.
fn endpoint_codebook(endpoints: &[Endpoint]) -> Vec<u8> {
    let mut symbols = Vec::new();
    let mut previous = Endpoint { colour: [16; 3], table: 0 };
    for &endpoint in endpoints {
        let table_step = endpoint.table.wrapping_sub(previous.table) & 7;
        symbols.push(Symbol { code: TABLE, value: usize::from(table_step) });
        for (value, before) in endpoint.colour.into_iter().zip(previous.colour) {
            let code = match before {
                0..=9 => 0,
                10..=21 => 1,
                _ => 2,
            };
            symbols.push(Symbol { code, value: usize::from(value.wrapping_sub(before) & 31) });
        }
        previous = endpoint;
    }

    let streams = [symbols];
    let codes: [Code; 4] = codes(&streams);
    let mut bits = BitWriter::default();
    for code in &codes {
        code.write_table(&mut bits);
    }
    // Three channels rather than grey alone.
    bits.put(0, 1);
    write_symbols(&mut bits, &codes, &streams[0]);
    bits.into_bytes()
}

/// Returns the bytes of the selector codebook.
fn selector_codebook(selectors: &[Selectors]) -> Vec<u8> {
    let mut bits = BitWriter::default();
    // Neither a codebook shared between files nor a mixture of the two kinds, and plain bytes follow.
    bits.put(0, 1);
    bits.put(0, 1);
    bits.put(1, 1);
    for &row in selectors.iter().flatten() {
        bits.put(u32::from(row), 8);
    }
    bits.into_bytes()
}

/// Returns the bytes of the tables of the codes that slices use.
fn code_tables(codes: &[Code; 3]) -> Vec<u8> {
    let mut bits = BitWriter::default();
    for code in codes {
        code.write_table(&mut bits);
    }
    let run_lengths = Code::new([]);
    run_lengths.write_table(&mut bits);
    bits.put(SELECTOR_HISTORY_SIZE, 13);
    bits.into_bytes()
}

/// Returns the bytes of 32-bit numbers.
fn words<const COUNT: usize>(values: [usize; COUNT]) -> impl Iterator<Item = u8> {
    values.into_iter().flat_map(|value| (value as u32).to_le_bytes())
}
