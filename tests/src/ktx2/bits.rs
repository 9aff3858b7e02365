//! Fields of bits, the lowest bit of every byte first, as all Basis Universal streams have them.

/// A growing row of bits.
#[derive(Default)]
pub(super) struct BitWriter {
    bytes: Vec<u8>,
    length: usize,
}

impl BitWriter {
    /// Appends the lowest `count` bits of a value, the lowest first.
    pub(super) fn put(&mut self, value: u32, count: u32) {
        for position in 0..count {
            let bit = (value >> position) & 1;
            if self.length.is_multiple_of(8) {
                self.bytes.push(0);
            }
            self.bytes[self.length / 8] |= (bit as u8) << (self.length % 8);
            self.length += 1;
        }
    }

    /// Returns the bytes; the unused bits of the last one are zero.
    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}
