//! Canonical prefix codes and the tables that describe them to a BasisLZ decoder.
//!
//! The decoder takes any complete prefix code. These ones give every symbol that occurs about the same
//! length instead of weighing them by frequency, which keeps the encoder simple and all codes short.

use super::bits::BitWriter;

/// The most symbols a code may have: the decoder links long codes through 16-bit signed numbers, two
/// for each symbol, and the reference encoder stays below the same limit.
pub(super) const MAX_SYMBOLS: usize = 16128;

/// The longest code of a symbol that a table can describe.
const MAX_LENGTH: u32 = 16;

/// The order in which a table lists the symbols of its code: the codes for runs, which are not used
/// here, and then the lengths from the likely ones to the rare ones.
const LENGTH_ORDER: [usize; 21] = [17, 18, 19, 20, 0, 8, 7, 9, 6, 10, 5, 11, 4, 12, 3, 13, 2, 14, 1, 15, 16];

/// A symbol and the number of the code that it is written in.
pub(super) struct Symbol {
    /// Which of the codes of a stream the symbol belongs to.
    pub(super) code: usize,
    /// The symbol itself.
    pub(super) value: usize,
}

/// A prefix code.
pub(super) struct Code {
    /// Bits of each symbol's code word, zero for a symbol that does not occur.
    lengths: Vec<u32>,
    /// The code words, with the bit that is written first as the lowest.
    words: Vec<u32>,
}

impl Code {
    /// Returns a code for the symbols that occur.
    pub(super) fn new(symbols: impl IntoIterator<Item = usize>) -> Self {
        let mut used: Vec<usize> = symbols.into_iter().collect();
        if used.is_empty() {
            // A decoder refuses a code without symbols, even where it never reads one.
            used.push(0);
        }
        used.sort_unstable();
        used.dedup();

        let shorter_length = used.len().ilog2();
        let shorter_count = (2 << shorter_length) - used.len();
        let mut lengths = vec![0; used[used.len() - 1] + 1];
        for (rank, &symbol) in used.iter().enumerate() {
            let length = shorter_length + u32::from(rank >= shorter_count);
            // The only symbol of a code still needs a bit.
            lengths[symbol] = length.max(1);
        }
        let words = canonical_codes(&lengths);
        Self { lengths, words }
    }

    /// Writes the code word of a symbol.
    pub(super) fn write_symbol(&self, bits: &mut BitWriter, symbol: usize) {
        bits.put(self.words[symbol], self.lengths[symbol]);
    }

    /// Writes the lengths of the code words, from which the decoder derives the words.
    pub(super) fn write_table(&self, bits: &mut BitWriter) {
        bits.put(self.lengths.len() as u32, 14);
        let length_code = Code::new(self.lengths.iter().map(|&length| length as usize));
        bits.put(LENGTH_ORDER.len() as u32, 5);
        for length in LENGTH_ORDER {
            bits.put(length_code.lengths.get(length).copied().unwrap_or(0), 3);
        }
        for &length in &self.lengths {
            length_code.write_symbol(bits, length as usize);
        }
    }
}

/// Returns the code words: shorter ones count up before longer ones, and equal lengths in symbol order.
fn canonical_codes(lengths: &[u32]) -> Vec<u32> {
    let mut words = vec![0; lengths.len()];
    let mut next: u32 = 0;
    for length in 1..=MAX_LENGTH {
        for (word, _) in words.iter_mut().zip(lengths).filter(|(_, other)| **other == length) {
            // The highest bit is written first, and the writer starts with the lowest.
            *word = next.reverse_bits() >> (u32::BITS - length);
            next += 1;
        }
        next <<= 1;
    }
    words
}

/// Returns the codes for a number of streams that share them.
pub(super) fn codes<const COUNT: usize>(streams: &[Vec<Symbol>]) -> [Code; COUNT] {
    std::array::from_fn(|number| {
        let symbols = streams.iter().flatten().filter(|symbol| symbol.code == number);
        Code::new(symbols.map(|symbol| symbol.value))
    })
}

/// Writes the symbols of a stream, each in its code.
pub(super) fn write_symbols(bits: &mut BitWriter, codes: &[Code], symbols: &[Symbol]) {
    for symbol in symbols {
        codes[symbol.code].write_symbol(bits, symbol.value);
    }
}
