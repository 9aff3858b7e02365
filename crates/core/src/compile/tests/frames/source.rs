//! Decisions from bytes.

/// Reads one byte for each decision. After the end every byte is zero, which stands for simple decisions.
pub(in super::super) struct Source<'b> {
    bytes: &'b [u8],
    at: usize,
}

impl<'b> Source<'b> {
    pub(in super::super) fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, at: 0 }
    }

    pub(in super::super) fn is_empty(&self) -> bool {
        self.at >= self.bytes.len()
    }

    /// Returns a number below `count`, which is 1 to 256.
    pub(in super::super) fn below(&mut self, count: usize) -> usize {
        let byte = self.bytes.get(self.at).copied().unwrap_or(0);
        self.at += 1;
        usize::from(byte) * count.max(1) / 256
    }

    /// Returns true for `of` of 256 bytes, and never for zero.
    pub(in super::super) fn chance(&mut self, of: usize) -> bool {
        self.below(256) + of >= 256
    }

    pub(in super::super) fn pick<T: Copy>(&mut self, from: &[T]) -> T {
        from[self.below(from.len())]
    }
}
