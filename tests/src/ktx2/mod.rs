//! Writes KTX2 files with Basis Universal content, for tests that need textures of their own.
#![allow(clippy::missing_panics_doc, clippy::must_use_candidate, reason = "tests")]

mod basislz;
mod bits;
mod container;
mod etc1s;
mod huffman;
mod ramp;
mod uastc;

pub use etc1s::etc1s;
pub use uastc::uastc;

/// An image, rows from the top, four bytes per pixel.
pub struct Image {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue and alpha of every pixel.
    pub rgba: Vec<u8>,
}

/// The pixels of a block of 4x4, rows from the top.
type Block = [[u8; 4]; 16];

impl Image {
    /// Says whether any pixel is not fully opaque.
    fn has_alpha(&self) -> bool {
        self.rgba.chunks_exact(4).any(|pixel| pixel[3] < 255)
    }

    /// The number of blocks side by side that cover a row.
    fn blocks_across(&self) -> usize {
        self.width.div_ceil(4) as usize
    }

    /// The blocks that cover the image, rows of blocks from the top.
    fn blocks(&self) -> impl Iterator<Item = Block> {
        let rows = (0..self.height).step_by(4);
        rows.flat_map(move |top| (0..self.width).step_by(4).map(move |left| self.block(left, top)))
    }

    /// The block whose first pixel is the given one; the last column and row repeat beyond the edge.
    fn block(&self, left: u32, top: u32) -> Block {
        std::array::from_fn(|position| {
            let x = (left as usize + position % 4).min(self.width as usize - 1);
            let y = (top as usize + position / 4).min(self.height as usize - 1);
            let start = (y * self.width as usize + x) * 4;
            std::array::from_fn(|channel| self.rgba[start + channel])
        })
    }
}
