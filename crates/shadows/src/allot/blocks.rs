//! The free places of a map, as a buddy allocator has them, four to a block.

/// Free blocks, the largest that there are. A block of level l is the 4^l cells from a multiple of 4^l on.
#[derive(Debug)]
pub(super) struct FreeBlocks {
    /// The first cells of the blocks of each level, descending, so that the lowest is the last.
    by_level: Vec<Vec<u64>>,
}

impl FreeBlocks {
    /// Nothing is free, in a map of this level.
    pub(super) fn none(map_level: u32) -> Self {
        Self { by_level: vec![Vec::new(); map_level as usize + 1] }
    }

    /// Makes the cells from `start` to before `end` free. Nothing between them and the first free cell may become
    /// free afterwards, and all that is free comes after them.
    pub(super) fn add_before_all(&mut self, start: u64, mut end: u64) {
        while start < end {
            let level = (end.trailing_zeros() / 2).min((end - start).ilog2() / 2);
            end -= 1 << (2 * level);
            self.by_level[level as usize].push(end);
        }
    }

    /// Takes a block of a level from the lowest of the smallest free blocks that hold it. Returns its first cell, or
    /// `None` if no free block is large enough.
    pub(super) fn take(&mut self, level: u32) -> Option<u64> {
        let level = level as usize;
        let from = (level..self.by_level.len()).find(|&level| !self.by_level[level].is_empty())?;
        let start = self.by_level[from].pop()?;
        for level in level..from {
            // The first quarter is taken or divided further. There was no free block of this level.
            let quarter = 1 << (2 * level);
            self.by_level[level].extend([3, 2, 1].map(|i| start + i * quarter));
        }
        Some(start)
    }
}
