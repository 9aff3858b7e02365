//! Inputs and results of an allocation.

use std::cmp::Ordering;

use crate::atlas::TileRect;

/// The most tiles that an owner may request.
pub(super) const MAX_TILES: u32 = 32;

/// The width of the map and the sizes that its tiles may have.
///
/// All three are powers of two; other values are rounded down to one. Where sizes contradict each other, the map's size
/// wins over the largest tile's, and that over the smallest tile's; tiles are at least one pixel wide. In a map
/// without pixels every request is rejected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct AtlasConfig {
    /// Width and height of the map, pixels.
    pub map_px: u32,
    /// Width and height of the smallest tiles, pixels.
    pub smallest_px: u32,
    /// Width and height of the largest tiles, pixels.
    pub largest_px: u32,
    /// Number of times that a requested size may be doubled where the map has space for it; at most 8.
    pub growth: u32,
}

impl AtlasConfig {
    /// Returns the sizes that are used in place of these, or `None` for a map without pixels.
    pub(super) fn normalized(&self) -> Option<Self> {
        let map_px = floor_to_power_of_two(self.map_px)?;
        let largest_px = floor_to_power_of_two(self.largest_px.min(map_px)).unwrap_or(1);
        let smallest_px = floor_to_power_of_two(self.smallest_px.min(largest_px)).unwrap_or(1);
        Some(Self { map_px, smallest_px, largest_px, growth: self.growth.min(8) })
    }
}

fn floor_to_power_of_two(px: u32) -> Option<u32> {
    px.checked_ilog2().map(|exponent| 1 << exponent)
}

/// A light's request for tiles in a map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileRequest {
    /// The light: its index, or any other unique number. Of requests with the same owner only the most
    /// important one counts.
    pub owner: u32,
    /// Number of tiles, all of the same size: 1 to 32. Either all are allocated or none. A request
    /// for zero tiles is ignored; one for more than 32 is rejected and does not affect the others.
    pub tiles: u32,
    /// Requested width of a tile, pixels, clamped between the smallest and the largest. A value that is not finite
    /// counts as the smallest.
    pub size_px: f64,
    /// Priority: higher values are served first, and at equal values the lower owner. A value that is not finite
    /// counts as less than every other.
    pub importance: f64,
}

impl TileRequest {
    fn normalized(&self) -> Self {
        let importance = if self.importance.is_finite() { self.importance } else { f64::NEG_INFINITY };
        // Adding zero makes negative zero positive, so that the two are equally important.
        Self { importance: importance + 0.0, ..*self }
    }

    fn by_owner(&self, other: &Self) -> Ordering {
        let then = self.owner.cmp(&other.owner).then(other.importance.total_cmp(&self.importance));
        then.then(other.size_px.total_cmp(&self.size_px)).then(other.tiles.cmp(&self.tiles))
    }
}

/// Returns the requests that count, by owner.
pub(super) fn normalize(requests: &[TileRequest]) -> Vec<TileRequest> {
    let mut normalized: Vec<TileRequest> =
        requests.iter().filter(|request| request.tiles > 0).map(TileRequest::normalized).collect();
    normalized.sort_unstable_by(TileRequest::by_owner);
    normalized.dedup_by_key(|request| request.owner);
    normalized
}

/// The tiles of a map and their owners. The default is empty.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AtlasAllocation {
    /// The owners that have tiles, in ascending order. Leave it unchanged if it is passed to the next frame.
    pub owners: Vec<TileAllocation>,
    /// The tiles of all owners, in the order of `owners`. They do not overlap.
    pub rects: Vec<TileRect>,
    /// The owners without tiles for lack of space, in ascending order.
    pub rejected: Vec<u32>,
    /// Whether the map was repacked because of fragmentation: then owners may have moved although their size is unchanged.
    pub repacked: bool,
    /// The normalized configuration that it was made with.
    pub(super) config: AtlasConfig,
}

/// The tiles of one owner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct TileAllocation {
    /// The light.
    pub owner: u32,
    /// Width and height of each tile, pixels: a power of two.
    pub tile_px: u32,
    /// The requested size, rounded to a power of two, pixels. `tile_px` is at most this times two to the power of [`AtlasConfig::growth`].
    pub requested_px: u32,
    /// Index of the first of its tiles in [`AtlasAllocation::rects`].
    pub first_rect: usize,
    /// Number of tiles.
    pub tiles: usize,
}

impl AtlasAllocation {
    /// Returns the allocation of an owner; `None` if it has no tiles.
    #[must_use]
    pub fn for_owner(&self, owner: u32) -> Option<&TileAllocation> {
        let index = self.owners.binary_search_by_key(&owner, |entry| entry.owner).ok()?;
        self.owners.get(index)
    }

    /// Returns an owner's tiles, in the order of its views; empty if it has none.
    #[must_use]
    pub fn rects_for(&self, owner: u32) -> &[TileRect] {
        self.for_owner(owner).map_or(&[], |entry| self.rects_in(entry))
    }

    /// Iterates over all owners and their tiles, by owner.
    pub fn iter(&self) -> impl Iterator<Item = (&TileAllocation, &[TileRect])> {
        self.owners.iter().map(|entry| (entry, self.rects_in(entry)))
    }

    fn rects_in(&self, entry: &TileAllocation) -> &[TileRect] {
        let from = self.rects.get(entry.first_rect..).unwrap_or(&[]);
        from.get(..entry.tiles).unwrap_or(&[])
    }
}
