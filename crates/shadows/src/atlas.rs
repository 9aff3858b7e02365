//! Layouts of tiles in a map.

use glam::{DMat4, DVec2, DVec3, Vec2};
use shadowgraph_core::Rect;

/// Largest number of tiles in an atlas of even tiles.
pub const MAX_ATLAS_TILES: usize = 16;

/// The rectangle of a tile, pixels from the top left of the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileRect {
    /// First column.
    pub x: u32,
    /// First row.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A map's size and its tiles: squares of one size that do not overlap.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileLayout {
    /// Width and height of the map, pixels. Unused rows of tiles are omitted.
    pub size_px: [u32; 2],
    /// Width and height of a tile, pixels.
    pub tile_px: u32,
    /// The tiles, row by row.
    pub tiles: Vec<TileRect>,
}

/// Lays out `count` tiles of one size, 1 to 64, in the smallest square grid: 1, 2, 3 or 4 per row for up to 1, 4,
/// 9 and 16 tiles. A single tile has the whole map, two are next to each other, three and four form a square.
///
/// ```
/// use shadowgraph_shadows::even_tiles;
/// assert_eq!(even_tiles(2, 4096).size_px, [4096, 2048]);
/// ```
#[must_use]
pub fn even_tiles(count: usize, map_size_px: u32) -> TileLayout {
    let per_row = (1..8).find(|row| row * row >= count as u32).unwrap_or(8);
    grid(count, per_row, map_size_px)
}

/// Returns the width of the smallest even tile of an atlas, pixels.
#[must_use]
pub fn smallest_atlas_tile_px(map_size_px: u32) -> u32 {
    map_size_px / 4
}

fn grid(count: usize, per_row: u32, map_size_px: u32) -> TileLayout {
    let tile_px = map_size_px / per_row;
    let count = u32::try_from(count).unwrap_or(u32::MAX).min(per_row * per_row);
    let tile = |i: u32| TileRect {
        x: i % per_row * tile_px,
        y: i / per_row * tile_px,
        width: tile_px,
        height: tile_px,
    };
    // The full width of the map: with three tiles per row the last columns stay free.
    let rows = count.div_ceil(per_row).max(1);
    let height = if rows == per_row { map_size_px } else { rows * tile_px };
    TileLayout { size_px: [map_size_px, height], tile_px, tiles: (0..count).map(tile).collect() }
}

impl From<TileRect> for Rect {
    fn from(tile: TileRect) -> Self {
        Self::new(tile.x, tile.y, tile.width, tile.height)
    }
}

impl TileRect {
    /// Returns whether two tiles overlap.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let disjoint = |a: u32, a_len: u32, b: u32, b_len: u32| a + a_len <= b || b + b_len <= a;
        !disjoint(self.x, self.width, other.x, other.width)
            && !disjoint(self.y, self.height, other.y, other.height)
    }

    /// Returns the matrix from the tile's clip space to the map: x and y from 0 to 1 over the whole map, y
    /// downwards; depth is unchanged.
    #[must_use]
    pub fn map_from_clip(&self, map_size_px: [u32; 2]) -> DMat4 {
        let map = DVec2::new(f64::from(map_size_px[0]), f64::from(map_size_px[1]));
        let half = DVec2::new(f64::from(self.width), f64::from(self.height)) * 0.5;
        let center = DVec2::new(f64::from(self.x), f64::from(self.y)) + half;
        let (scale, center) = (half / map, center / map);
        DMat4::from_translation(center.extend(0.0)) * DMat4::from_scale(DVec3::new(scale.x, -scale.y, 1.0))
    }

    /// Returns the corners of the tile without its border, in texture coordinates of the map: around points inside, a
    /// filter with the border's radius stays inside the tile.
    #[must_use]
    pub fn inner_uv(&self, map_size_px: [u32; 2], border_px: u32) -> (Vec2, Vec2) {
        let map = Vec2::new(map_size_px[0] as f32, map_size_px[1] as f32);
        let uv = |x: u32, y: u32| Vec2::new(x as f32, y as f32) / map;
        let min = uv(self.x + border_px, self.y + border_px);
        let max = uv(self.x + self.width - border_px, self.y + self.height - border_px);
        (min, max)
    }
}
