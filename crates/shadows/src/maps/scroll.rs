//! Tiles that scroll: the texels that come in, and where the store of static casters has them.
//!
//! The store wraps around (Day, "CSM scrolling", SIGGRAPH 2012): a texel of the world keeps its place in it for as long as it
//! is in the tile, so nothing is copied as the tile moves, and no error accumulates.

use crate::atlas::TileRect;

/// A rectangle of the world's texels, counted as [`OrthoFit::first_texel`](crate::OrthoFit::first_texel) does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Texels {
    pub(super) first: [i64; 2],
    pub(super) size: [u32; 2],
}

impl Texels {
    /// Returns the texel after the last one of each axis.
    fn end(&self, axis: usize) -> i64 {
        self.first[axis] + i64::from(self.size[axis])
    }

    /// Returns the intersection; `None` if it is empty.
    pub(super) fn common(&self, other: &Self) -> Option<Self> {
        let first = [0, 1].map(|axis| self.first[axis].max(other.first[axis]));
        let end = [0, 1].map(|axis| self.end(axis).min(other.end(axis)));
        Self::between(first, end)
    }

    fn between(first: [i64; 2], end: [i64; 2]) -> Option<Self> {
        let size = [0, 1].map(|axis| u32::try_from(end[axis] - first[axis]).unwrap_or(0));
        size.iter().all(|side| *side > 0).then_some(Self { first, size })
    }

    /// Returns the number of texels.
    pub(super) fn count(&self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// Returns the texels that come in as a tile moves, as at most two rectangles: a strip of columns, and one of rows in the
/// other columns.
pub(super) fn entering(before: &Texels, after: &Texels) -> Vec<Texels> {
    let Some(common) = before.common(after) else { return vec![*after] };
    let next_to = |axis: usize, rest: &Texels| {
        let mut part = *rest;
        part.size[axis] = after.size[axis] - common.size[axis];
        part.first[axis] =
            if common.first[axis] > after.first[axis] { after.first[axis] } else { common.end(axis) };
        (part.size[axis] > 0).then_some(part)
    };
    let rows = Texels { first: [common.first[0], after.first[1]], size: [common.size[0], after.size[1]] };
    [next_to(0, after), next_to(1, &rows)].into_iter().flatten().collect()
}

/// A rectangle of the store without a wrap in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Piece {
    /// The rectangle in the map.
    pub(super) rect: TileRect,
    /// Where the tile's top left would be in the map if the texels around the piece did not wrap.
    pub(super) tile_at: [i64; 2],
}

/// Returns where a tile of the store with this anchor has some texels of the window that begins at `first`: up to four pieces.
pub(super) fn pieces(tile: &TileRect, anchor: [i64; 2], first: [i64; 2], texels: &Texels) -> Vec<Piece> {
    let (corner, size) = ([tile.x, tile.y], [tile.width, tile.height]);
    // Each axis: first texel, number of texels, and the texel at the tile's first column or row.
    let spans = [0, 1].map(|axis| {
        let side = i64::from(size[axis]);
        let mut spans = Vec::with_capacity(2);
        let mut from = texels.first[axis];
        while from < texels.end(axis) {
            let begin = from - (from - anchor[axis]).rem_euclid(side);
            let to = texels.end(axis).min(begin + side);
            spans.push((from, to - from, begin));
            from = to;
        }
        spans
    });
    let across = |down: (i64, i64, i64)| spans[0].iter().map(move |&across| [across, down]);
    let piece = |span: [(i64, i64, i64); 2]| {
        let at = [0, 1].map(|axis| corner[axis] + (span[axis].0 - span[axis].2) as u32);
        let rect = TileRect { x: at[0], y: at[1], width: span[0].1 as u32, height: span[1].1 as u32 };
        let tile_at = [0, 1].map(|axis| i64::from(corner[axis]) + first[axis] - span[axis].2);
        Piece { rect, tile_at }
    };
    spans[1].iter().flat_map(|&down| across(down)).map(piece).collect()
}

/// Returns the offset in a tile of the store at which a window begins: [`pieces`] wrap there.
pub(super) fn wrap(tile: &TileRect, anchor: [i64; 2], first: [i64; 2]) -> [u32; 2] {
    let size = [tile.width, tile.height];
    [0, 1].map(|axis| (first[axis] - anchor[axis]).rem_euclid(i64::from(size[axis])) as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TILE: TileRect = TileRect { x: 16, y: 8, width: 8, height: 8 };

    /// Returns the texel of the world that each texel of the store has after drawing `texels`.
    fn draw(store: &mut [[Option<[i64; 2]>; 8]; 8], first: [i64; 2], texels: &Texels) {
        for Piece { rect, tile_at } in pieces(&TILE, [3, -5], first, texels) {
            for y in rect.y..rect.y + rect.height {
                for x in rect.x..rect.x + rect.width {
                    let texel = [0, 1].map(|axis| first[axis] + i64::from([x, y][axis]) - tile_at[axis]);
                    store[(y - TILE.y) as usize][(x - TILE.x) as usize] = Some(texel);
                }
            }
        }
    }

    #[test]
    fn after_any_walk_every_texel_of_the_window_is_where_the_wrap_says() {
        let mut store = [[None; 8]; 8];
        let mut window = Texels { first: [3, -5], size: [8, 8] };
        draw(&mut store, window.first, &window);
        let mut drawn = 0;
        for step in [[1, 0], [0, -1], [3, 2], [-7, 7], [0, 0], [-1, -8], [20, 0], [2, -3]] {
            let after = Texels { first: [window.first[0] + step[0], window.first[1] + step[1]], ..window };
            for strip in entering(&window, &after) {
                drawn += strip.count();
                draw(&mut store, after.first, &strip);
            }
            window = after;
            let [across, down] = wrap(&TILE, [3, -5], window.first);
            for y in 0..8_u32 {
                for x in 0..8_u32 {
                    let at = store[((y + down) % 8) as usize][((x + across) % 8) as usize];
                    let texel = [window.first[0] + i64::from(x), window.first[1] + i64::from(y)];
                    assert_eq!(at, Some(texel), "after {step:?}");
                }
            }
        }
        // 8, 8, 24 + 16 - 6, 63, 0, all, all, 16 + 24 - 6.
        assert_eq!(drawn, 8 + 8 + 34 + 63 + 64 + 64 + 34);
    }
}
