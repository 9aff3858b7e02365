//! What is granted, which is also the memory for the next frame.

use super::ask::Ask;
use super::levels::Levels;
use super::rules::AllotRules;
use crate::TileRect;

/// Who has which tiles of a map. The default holds nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Allotment {
    /// Who has tiles, by owner. To be left as it is if it is to serve as memory.
    pub granted: Vec<Granted>,
    /// The tiles of all owners, in their order. None overlaps another.
    pub rects: Vec<TileRect>,
    /// The owners for whom there is no room, in ascending order.
    pub refused: Vec<u32>,
    /// Whether even owners whose sizes stayed may have lost their places, since what was free was in pieces.
    pub repacked: bool,
    /// The rules that it was made with.
    pub(super) rules: AllotRules,
}

/// The size of an owner's tiles and which they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Granted {
    /// The light.
    pub owner: u32,
    /// Width and height of each tile, pixels: a power of two.
    pub tile_px: u32,
    /// The size that was wished for, rounded to a power of two, pixels. `tile_px` is this or less.
    pub wished_px: u32,
    /// The first of its tiles in [`Allotment::rects`].
    pub first_rect: usize,
    /// How many tiles it has.
    pub tiles: usize,
}

impl Allotment {
    /// Returns what an owner has; `None` if it has nothing.
    #[must_use]
    pub fn granted_to(&self, owner: u32) -> Option<&Granted> {
        let index = self.granted.binary_search_by_key(&owner, |granted| granted.owner).ok()?;
        self.granted.get(index)
    }

    /// Returns an owner's tiles, in the order of its views; none if it has nothing.
    #[must_use]
    pub fn rects_of(&self, owner: u32) -> &[TileRect] {
        self.granted_to(owner).map_or(&[], |granted| self.rects_in(granted))
    }

    /// Goes through all owners and their tiles, by owner.
    pub fn iter(&self) -> impl Iterator<Item = (&Granted, &[TileRect])> {
        self.granted.iter().map(|granted| (granted, self.rects_in(granted)))
    }

    fn rects_in(&self, granted: &Granted) -> &[TileRect] {
        let from = self.rects.get(granted.first_rect..).unwrap_or(&[]);
        from.get(..granted.tiles).unwrap_or(&[])
    }
}

/// Returns the entries for asks that are served, by owner.
pub(super) fn granted(levels: &Levels, asks: &[Ask]) -> Vec<Granted> {
    let mut first_rect = 0;
    let entry = |ask: &Ask| {
        let tiles = ask.tiles as usize;
        first_rect += tiles;
        Granted {
            owner: ask.owner,
            tile_px: levels.px(ask.level),
            wished_px: levels.px(ask.wished),
            first_rect: first_rect - tiles,
            tiles,
        }
    };
    asks.iter().map(entry).collect()
}
