//! A wish in levels, with what is remembered of its owner.

use std::cmp::Ordering;

use super::allotment::Allotment;
use super::levels::Levels;
use super::wish::TileWish;

/// A wished size stays while the continuous wish is less than this factor away from it, in either direction: √2
/// beyond the border of rounding.
///
/// So a wish may swing by a factor of √2 around any value, +-17 %, and changes the wished size once at most. The
/// factor is not above 2, since then a wish that is held at the largest size might be kept at half of it for ever.
pub(crate) const WISH_WINDOW: f64 = 2.0;

/// A wish in levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ask {
    /// Whose it is.
    pub(super) owner: u32,
    /// How many tiles.
    pub(super) tiles: u32,
    /// The more, the earlier.
    pub(super) importance: f64,
    /// The level of the wished size.
    pub(super) wished: u32,
    /// How often the wished size was halved in the frame before; 0 for a new owner.
    pub(super) halved_before: u32,
    /// The level of the size that is granted.
    pub(super) level: u32,
}

impl Ask {
    /// Rounds a wish, near to what its owner had.
    pub(super) fn new(levels: &Levels, wish: &TileWish, previous: Option<&Allotment>) -> Self {
        let px = levels.clamp(wish.size_px);
        let before = previous.and_then(|previous| previous.granted_to(wish.owner));
        let wished_before = before.map(|before| levels.level(before.wished_px));
        let level_before = before.map_or(0, |before| levels.level(before.tile_px));
        let stays = |&level: &u32| {
            let size = f64::from(levels.px(level));
            size / WISH_WINDOW < px && px < size * WISH_WINDOW
        };
        Self {
            owner: wish.owner,
            tiles: wish.tiles,
            importance: wish.importance,
            wished: wished_before.filter(stays).unwrap_or_else(|| levels.nearest(px)),
            halved_before: wished_before.map_or(0, |wished| wished.saturating_sub(level_before)),
            level: 0,
        }
    }

    /// The order in which owners are served.
    pub(super) fn most_important_first(&self, other: &Self) -> Ordering {
        other.importance.total_cmp(&self.importance).then(self.owner.cmp(&other.owner))
    }

    /// The area of the tiles at a level, cells; the greatest number there is for what no map can hold.
    pub(super) fn cells(&self, level: u32) -> u64 {
        u64::from(self.tiles).saturating_mul(1 << (2 * level))
    }
}
