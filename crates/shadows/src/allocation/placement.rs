//! The position of each tile in the map.

use std::cmp::Reverse;

use super::sizes::{Levels, Request};
use super::types::AtlasAllocation;
use crate::atlas::TileRect;

/// The tiles of all requests, in their order.
pub(super) struct Placement {
    pub(super) rects: Vec<TileRect>,
    pub(super) repacked: bool,
}

/// A tile and, once it is placed, its first cell along the Morton curve.
#[derive(Clone, Copy)]
struct Tile {
    level: u32,
    start: Option<u64>,
}

/// Places every tile. The total area must not exceed the map's.
pub(super) fn place(levels: &Levels, requests: &[Request], previous: Option<&AtlasAllocation>) -> Placement {
    let mut tiles: Vec<Tile> = requests.iter().flat_map(|request| kept(levels, request, previous)).collect();
    let mut free = free_around(&mut tiles, levels.map());
    let repacked = !fill(&mut tiles, &mut free);
    if repacked {
        // Squares whose widths are powers of two, largest first, fill a map without gaps.
        tiles.iter_mut().for_each(|tile| tile.start = None);
        let mut free = free_around(&mut tiles, levels.map());
        let all_fit = fill(&mut tiles, &mut free);
        debug_assert!(all_fit, "the tiles are larger than the map");
    }
    Placement { rects: tiles.iter().map(|tile| rect(levels, tile)).collect(), repacked }
}

/// Returns a request's tiles, at their previous positions if the size is unchanged.
fn kept<'a>(
    levels: &'a Levels,
    request: &'a Request,
    previous: Option<&'a AtlasAllocation>,
) -> impl Iterator<Item = Tile> + 'a {
    let before = previous.map_or(&[][..], |previous| previous.rects_for(request.owner));
    (0..request.tiles as usize).map(move |i| {
        let start = before.get(i).and_then(|rect| first_cell(levels, rect, request.level));
        Tile { level: request.level, start }
    })
}

/// Returns the first cell of a rectangle if it is a block of the level inside the map.
fn first_cell(levels: &Levels, rect: &TileRect, level: u32) -> Option<u64> {
    let (side, map) = (levels.px(level), levels.config().map_px);
    let aligned = rect.x.is_multiple_of(side) && rect.y.is_multiple_of(side);
    let inside = rect.x < map && rect.y < map;
    let cell = levels.config().smallest_px;
    (rect.width == side && rect.height == side && aligned && inside)
        .then(|| morton_encode(rect.x / cell, rect.y / cell))
}

fn rect(levels: &Levels, tile: &Tile) -> TileRect {
    let [x, y] = morton_decode(tile.start.unwrap_or(0)).map(|cells| cells * levels.config().smallest_px);
    let side = levels.px(tile.level);
    TileRect { x, y, width: side, height: side }
}

/// Returns the free blocks between the placed tiles. A tile that would overlap another, which happens only if
/// the previous allocation was modified by the caller, loses its position.
fn free_around(tiles: &mut [Tile], map_level: u32) -> FreeBlocks {
    let mut placed: Vec<usize> = (0..tiles.len()).filter(|&i| tiles[i].start.is_some()).collect();
    placed.sort_by_key(|&i| Reverse(tiles[i].start));
    let mut free = FreeBlocks::none(map_level);
    let mut end = 1 << (2 * map_level);
    for i in placed {
        let Tile { level, start: Some(start) } = tiles[i] else { continue };
        let after = start + (1 << (2 * level));
        if after > end {
            tiles[i].start = None;
            continue;
        }
        free.prepend(after, end);
        end = start;
    }
    free.prepend(0, end);
    free
}

/// Places the tiles that have no position, largest first. Returns whether all of them fit.
///
/// In that order, a tile that does not fit would not fit in any order: the rest of a block that is split
/// is a whole number of blocks of the present size.
fn fill(tiles: &mut [Tile], free: &mut FreeBlocks) -> bool {
    let mut unplaced: Vec<usize> = (0..tiles.len()).filter(|&i| tiles[i].start.is_none()).collect();
    unplaced.sort_by_key(|&i| Reverse(tiles[i].level));
    unplaced.into_iter().all(|i| {
        tiles[i].start = free.take(tiles[i].level);
        tiles[i].start.is_some()
    })
}

/// The maximal free blocks of a map: a buddy allocator with four buddies. A block of level l is the 4^l cells that
/// begin at a multiple of 4^l.
#[derive(Debug)]
struct FreeBlocks {
    /// The first cells of the blocks of each level, descending, so that the lowest is the last.
    by_level: Vec<Vec<u64>>,
}

impl FreeBlocks {
    /// Returns the state in which nothing is free, in a map of this level.
    fn none(map_level: u32) -> Self {
        Self { by_level: vec![Vec::new(); map_level as usize + 1] }
    }

    /// Frees the cells from `start` up to but not including `end`. All cells that are free already must come after
    /// them, and those in between must stay in use.
    fn prepend(&mut self, start: u64, mut end: u64) {
        while start < end {
            let level = (end.trailing_zeros() / 2).min((end - start).ilog2() / 2);
            end -= 1 << (2 * level);
            self.by_level[level as usize].push(end);
        }
    }

    /// Takes a block of a level from the lowest of the smallest free blocks that hold it. Returns its first cell, or
    /// `None` if no free block is large enough.
    fn take(&mut self, level: u32) -> Option<u64> {
        let level = level as usize;
        let from = (level..self.by_level.len()).find(|&level| !self.by_level[level].is_empty())?;
        let start = self.by_level[from].pop()?;
        for level in level..from {
            // The first quarter is taken or split further. There was no free block of this level.
            let quarter = 1 << (2 * level);
            self.by_level[level].extend([3, 2, 1].map(|i| start + i * quarter));
        }
        Some(start)
    }
}

/// Returns the index of a cell along the Morton curve: the bits of column and row interleaved, the column's first.
fn morton_encode(x: u32, y: u32) -> u64 {
    spread_bits(x) | spread_bits(y) << 1
}

/// Returns the column and the row of a cell.
fn morton_decode(cell: u64) -> [u32; 2] {
    [gather_bits(cell), gather_bits(cell >> 1)]
}

/// Moves bit i to bit 2 i.
fn spread_bits(bits: u32) -> u64 {
    let mut bits = u64::from(bits);
    bits = (bits | bits << 16) & 0x0000_ffff_0000_ffff;
    bits = (bits | bits << 8) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits << 4) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits << 2) & 0x3333_3333_3333_3333;
    (bits | bits << 1) & 0x5555_5555_5555_5555
}

/// Moves bit 2 i to bit i and drops the others.
fn gather_bits(bits: u64) -> u32 {
    let mut bits = bits & 0x5555_5555_5555_5555;
    bits = (bits | bits >> 1) & 0x3333_3333_3333_3333;
    bits = (bits | bits >> 2) & 0x0f0f_0f0f_0f0f_0f0f;
    bits = (bits | bits >> 4) & 0x00ff_00ff_00ff_00ff;
    bits = (bits | bits >> 8) & 0x0000_ffff_0000_ffff;
    (bits | bits >> 16) as u32
}
