//! Where the tiles lie.

use std::cmp::Reverse;

use super::allotment::Allotment;
use super::ask::Ask;
use super::blocks::FreeBlocks;
use super::levels::Levels;
use super::morton;
use crate::TileRect;

/// The tiles of all asks, in their order.
pub(super) struct Places {
    pub(super) rects: Vec<TileRect>,
    pub(super) repacked: bool,
}

/// A tile and its first cell along the Morton curve, once it has a place.
#[derive(Clone, Copy)]
struct Tile {
    level: u32,
    start: Option<u64>,
}

/// Gives every tile a place. The areas must not be more than the map's.
pub(super) fn place(levels: &Levels, asks: &[Ask], previous: Option<&Allotment>) -> Places {
    let mut tiles: Vec<Tile> = asks.iter().flat_map(|ask| kept(levels, ask, previous)).collect();
    let mut free = free_around(&mut tiles, levels.map());
    let repacked = !fill(&mut tiles, &mut free);
    if repacked {
        // Squares that are powers of two wide, biggest first, fill a map without gaps.
        tiles.iter_mut().for_each(|tile| tile.start = None);
        let mut free = free_around(&mut tiles, levels.map());
        let all_fit = fill(&mut tiles, &mut free);
        debug_assert!(all_fit, "the tiles are larger than the map");
    }
    Places { rects: tiles.iter().map(|tile| rect(levels, tile)).collect(), repacked }
}

/// Returns an ask's tiles, in the places they had if their size is what it was.
fn kept<'a>(
    levels: &'a Levels,
    ask: &'a Ask,
    previous: Option<&'a Allotment>,
) -> impl Iterator<Item = Tile> + 'a {
    let before = previous.map_or(&[][..], |previous| previous.rects_of(ask.owner));
    (0..ask.tiles as usize).map(move |i| {
        let start = before.get(i).and_then(|rect| start_of(levels, rect, ask.level));
        Tile { level: ask.level, start }
    })
}

/// Returns the first cell of a rectangle if it is a block of the level inside the map.
fn start_of(levels: &Levels, rect: &TileRect, level: u32) -> Option<u64> {
    let (side, map) = (levels.px(level), levels.rules().map_px);
    let aligned = rect.x.is_multiple_of(side) && rect.y.is_multiple_of(side);
    let inside = rect.x < map && rect.y < map;
    let cell = levels.rules().smallest_px;
    (rect.width == side && rect.height == side && aligned && inside)
        .then(|| morton::encode(rect.x / cell, rect.y / cell))
}

fn rect(levels: &Levels, tile: &Tile) -> TileRect {
    let [x, y] = morton::decode(tile.start.unwrap_or(0)).map(|cells| cells * levels.rules().smallest_px);
    let side = levels.px(tile.level);
    TileRect { x, y, width: side, height: side }
}

/// Returns what is free between the tiles that have a place. A tile that would overlap another, which happens only if
/// the memory was changed by hand, loses its place.
fn free_around(tiles: &mut [Tile], map_level: u32) -> FreeBlocks {
    let mut taken: Vec<usize> = (0..tiles.len()).filter(|&i| tiles[i].start.is_some()).collect();
    taken.sort_by_key(|&i| Reverse(tiles[i].start));
    let mut free = FreeBlocks::none(map_level);
    let mut end = 1 << (2 * map_level);
    for i in taken {
        let Tile { level, start: Some(start) } = tiles[i] else { continue };
        let after = start + (1 << (2 * level));
        if after > end {
            tiles[i].start = None;
            continue;
        }
        free.add_before_all(after, end);
        end = start;
    }
    free.add_before_all(0, end);
    free
}

/// Gives the tiles without a place one, biggest first. Returns whether there was one for each.
///
/// In that order a tile finds no place only if there is none in any order: what is left of a block that is divided
/// is a whole number of blocks of the present size.
fn fill(tiles: &mut [Tile], free: &mut FreeBlocks) -> bool {
    let mut homeless: Vec<usize> = (0..tiles.len()).filter(|&i| tiles[i].start.is_none()).collect();
    homeless.sort_by_key(|&i| Reverse(tiles[i].level));
    homeless.into_iter().all(|i| {
        tiles[i].start = free.take(tiles[i].level);
        tiles[i].start.is_some()
    })
}
