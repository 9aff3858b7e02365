//! The size of each owner's tiles, as levels: level 0 is the smallest size, a cell, and each further level is twice as
//! wide.

use std::cmp::Ordering;
use std::f64::consts::SQRT_2;

use super::types::{AtlasAllocation, AtlasConfig, TileAllocation, TileRequest};

/// A requested size is kept while the continuous request is less than this factor away from it, in either direction: √2
/// beyond the rounding threshold.
///
/// So a request may vary by a factor of √2 around any value, +-17 %, and changes the rounded size at most once. The
/// factor is not above 2: otherwise a request clamped to the largest size could stay at half of it forever.
const REQUEST_HYSTERESIS: f64 = 2.0;

/// An owner whose size was halved grows again only while this fraction of the map (one part in 10) stays free and
/// nobody is rejected.
///
/// So a light that takes no more than that, and comes and goes, makes others smaller at most once, and never larger.
const GROWTH_SLACK: u64 = 10;

/// The levels that a configuration allows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levels {
    config: AtlasConfig,
}

impl Levels {
    /// Returns `None` if the map has no pixels.
    pub(super) fn new(config: &AtlasConfig) -> Option<Self> {
        Some(Self { config: config.normalized()? })
    }

    /// Returns the normalized configuration.
    pub(super) fn config(&self) -> AtlasConfig {
        self.config
    }

    /// Returns the level of the map, at most 31.
    pub(super) fn map(&self) -> u32 {
        self.level(self.config.map_px)
    }

    /// Returns the level of a width in pixels, rounded down and clamped between the smallest and the map's.
    pub(super) fn level(&self, px: u32) -> u32 {
        let cells = px.min(self.config.map_px) / self.config.smallest_px;
        cells.checked_ilog2().unwrap_or(0)
    }

    /// Returns the width of a level, pixels.
    pub(super) fn px(&self, level: u32) -> u32 {
        self.config.smallest_px << level
    }

    /// Returns the area of a tile of a level, cells.
    pub(super) fn cells(&self, level: u32) -> u64 {
        1 << (2 * level)
    }

    /// Clamps a requested width to the allowed range, pixels; a value that is not finite becomes the smallest.
    pub(super) fn clamp(&self, px: f64) -> f64 {
        let (smallest, largest) = (f64::from(self.config.smallest_px), f64::from(self.config.largest_px));
        if px.is_finite() { px.clamp(smallest, largest) } else { smallest }
    }

    /// Returns the level whose width is nearest, as a ratio, to a [clamped](Self::clamp) width.
    pub(super) fn nearest(&self, px: f64) -> u32 {
        // Without a logarithm, whose last digit differs between machines.
        let below = self.level(px as u32);
        below + u32::from(px > f64::from(self.px(below)) * SQRT_2)
    }
}

/// A request in levels.
#[derive(Clone, Copy, Debug)]
pub(super) struct Request {
    /// The owner.
    pub(super) owner: u32,
    /// Number of tiles.
    pub(super) tiles: u32,
    /// Priority: higher values are served first.
    pub(super) importance: f64,
    /// The level of the requested size.
    pub(super) requested: u32,
    /// The level of the largest size that it may get.
    pub(super) most: u32,
    /// Number of halvings of the largest size, without limit, in the previous frame; 0 for a new owner.
    pub(super) halved_before: u32,
    /// The level of the allocated size.
    pub(super) level: u32,
}

impl Request {
    /// Rounds a request, with hysteresis around the size that its owner requested before.
    pub(super) fn new(levels: &Levels, request: &TileRequest, previous: Option<&AtlasAllocation>) -> Self {
        let px = levels.clamp(request.size_px);
        let before = previous.and_then(|previous| previous.for_owner(request.owner));
        let requested_before = before.map(|before| levels.level(before.requested_px));
        let level_before = before.map_or(0, |before| levels.level(before.tile_px));
        let is_kept = |&level: &u32| {
            let size = f64::from(levels.px(level));
            size / REQUEST_HYSTERESIS < px && px < size * REQUEST_HYSTERESIS
        };
        let growth = levels.config().growth;
        let halvings = |requested: u32| (requested + growth).saturating_sub(level_before);
        Self {
            owner: request.owner,
            tiles: request.tiles,
            importance: request.importance,
            requested: requested_before.filter(is_kept).unwrap_or_else(|| levels.nearest(px)),
            most: levels.level(levels.config().largest_px),
            halved_before: requested_before.map_or(0, halvings),
            level: 0,
        }
    }

    /// Compares by priority: the most important first.
    pub(super) fn most_important_first(&self, other: &Self) -> Ordering {
        other.importance.total_cmp(&self.importance).then(self.owner.cmp(&other.owner))
    }

    /// Returns the area of the tiles at a level, cells; saturates for what no map can hold.
    fn cells(&self, level: u32) -> u64 {
        u64::from(self.tiles).saturating_mul(1 << (2 * level))
    }
}

/// Sets the levels of the requests, given most important first, in a map. Returns how many of them are admitted; the rest is rejected.
pub(super) fn assign_levels(levels: &Levels, requests: &mut [Request]) -> usize {
    let capacity = levels.cells(levels.map());
    let (admitted, total) = admit(capacity, requests);
    // Space that a rejected owner of several tiles leaves free is taken back as soon as it is admitted.
    let to_grow = if admitted == requests.len() { capacity - capacity.div_ceil(GROWTH_SLACK) } else { 0 };
    let growth = levels.config().growth;
    double(Limits { to_keep: capacity, to_grow }, growth, total, &mut requests[..admitted]);
    admitted
}

/// The most cells in use after an owner has been given a size.
#[derive(Clone, Copy)]
struct Limits {
    /// The limit for owners that were halved no further than now, and for new ones.
    to_keep: u64,
    /// The limit for owners that were halved further.
    to_grow: u64,
}

/// Returns how many requests fit at the smallest size, up to the first that does not, and how many cells they take.
fn admit(capacity: u64, requests: &[Request]) -> (usize, u64) {
    let mut total = 0;
    for (index, request) in requests.iter().enumerate() {
        let more = total + request.cells(0);
        if more > capacity {
            return (index, total);
        }
        total = more;
    }
    (requests.len(), total)
}

/// Doubles sizes in rounds, up to the first that does not fit.
fn double(limits: Limits, growth: u32, mut total: u64, requests: &mut [Request]) {
    let most = requests.iter().map(|request| request.requested + growth).max().unwrap_or(0);
    for halvings in (0..most).rev() {
        for request in requests.iter_mut() {
            let level = (request.requested + growth).saturating_sub(halvings).min(request.most);
            if level == request.level {
                continue;
            }
            // The tiles fit at their present level, so only the first of these can saturate.
            total = request.cells(level).saturating_add(total - request.cells(request.level));
            let limit = if halvings < request.halved_before { limits.to_grow } else { limits.to_keep };
            if total > limit {
                return;
            }
            request.level = level;
        }
    }
}

/// Returns the entries of admitted requests, given by owner.
pub(super) fn allocations(levels: &Levels, requests: &[Request]) -> Vec<TileAllocation> {
    let mut first_rect = 0;
    let entry = |request: &Request| {
        let tiles = request.tiles as usize;
        first_rect += tiles;
        TileAllocation {
            owner: request.owner,
            tile_px: levels.px(request.level),
            requested_px: levels.px(request.requested),
            first_rect: first_rect - tiles,
            tiles,
        }
    };
    requests.iter().map(entry).collect()
}
