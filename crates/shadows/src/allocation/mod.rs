//! Allocation of tiles in a square map: tiles sized by importance, at positions that stay the same from frame to frame.
//!
//! [`allocate_tiles`] is a pure function. Its only state is the [`AtlasAllocation`] of the previous frame. It has four
//! steps:
//!
//! 1. *Requested sizes.* Each request is rounded to the nearest power of two, unless the size that the owner requested
//!    before is still less than a factor of 2 away.
//! 2. *Admission.* With every tile at the smallest size, owners are admitted from the most important one on, up to the
//!    first that does not fit. That one and all after it are rejected. The previous frame has no influence on it.
//! 3. *Sizes.* Every admitted owner begins at the smallest size and approaches the largest that it may get, its requested size
//!    doubled [`AtlasConfig::growth`] times, by doubling: in rounds of one doubling each, within a round from the most important
//!    owner on, up to the first that does not fit. So all sizes are halved k times or k - 1 times, and k - 1 times for the most
//!    important owners.
//!    An owner that was halved further in the previous frame grows only while a tenth of the map
//!    stays free and nobody is rejected.
//! 4. *Placement.* Owners keep their positions while their size is unchanged. The others are put into free blocks,
//!    largest first, each into the smallest free block that holds it. Only if that fails is the whole map repacked.
//!
//! The price of hysteresis: if somebody has less than the most and nobody is rejected, the free part of the map is less
//! than the slack and the next doubling together; without a previous frame, less than that doubling. Importance has no
//! hysteresis here: two owners that swap ranks from frame to frame may also swap sizes, since the more important one is
//! never the smaller one.
//!
//! A *block* is an aligned square whose width is a power of two. Along the Morton curve (Z-order curve) each
//! block is an interval of cells that begins at a multiple of its length, which is a power of four. So the map is
//! handled as a line.

mod placement;
mod sizes;
#[cfg(test)]
mod tests;
mod types;

use sizes::{Levels, Request};

pub use types::{AtlasAllocation, AtlasConfig, TileAllocation, TileRequest};

/// Allocates tiles in a square map, close to the allocation of the previous frame.
///
/// The order of `requests` does not matter. `previous` is ignored if it was made with another configuration.
///
/// ```
/// use shadowgraph_shadows::{AtlasConfig, TileRequest, allocate_tiles};
/// let config = AtlasConfig { map_px: 1024, smallest_px: 32, largest_px: 512, growth: 0 };
/// let point = TileRequest { owner: 3, tiles: 6, size_px: 230.0, importance: 1.0 };
/// let spot = TileRequest { owner: 1, tiles: 1, size_px: 600.0, importance: 0.5 };
/// let allocation = allocate_tiles(&config, &[point, spot], None);
/// assert_eq!(allocation.rects_for(3).len(), 6);
/// assert_eq!(allocation.rects_for(3)[0].width, 256);
/// assert_eq!(allocation.rects_for(1)[0].width, 512);
/// // The next frame, a little farther away.
/// let point = TileRequest { size_px: 170.0, ..point };
/// assert_eq!(allocate_tiles(&config, &[spot, point], Some(&allocation)).rects, allocation.rects);
/// ```
#[must_use]
pub fn allocate_tiles(
    config: &AtlasConfig,
    requests: &[TileRequest],
    previous: Option<&AtlasAllocation>,
) -> AtlasAllocation {
    let requests = types::normalize(requests);
    let Some(levels) = Levels::new(config) else {
        let rejected = requests.iter().map(|request| request.owner).collect();
        return AtlasAllocation { rejected, ..AtlasAllocation::default() };
    };
    let (requests, excessive): (Vec<_>, Vec<_>) =
        requests.into_iter().partition(|request| request.tiles <= types::MAX_TILES);
    let previous = previous.filter(|previous| previous.config == levels.config());
    let mut requests: Vec<Request> =
        requests.iter().map(|request| Request::new(&levels, request, previous)).collect();
    requests.sort_unstable_by(Request::most_important_first);
    let admitted = sizes::assign_levels(&levels, &mut requests);
    let mut rejected: Vec<u32> = excessive.iter().map(|request| request.owner).collect();
    rejected.extend(requests.drain(admitted..).map(|request| request.owner));
    rejected.sort_unstable();
    requests.sort_unstable_by_key(|request| request.owner);
    let placement = placement::place(&levels, &requests, previous);
    AtlasAllocation {
        owners: sizes::allocations(&levels, &requests),
        rects: placement.rects,
        rejected,
        repacked: placement.repacked,
        config: levels.config(),
    }
}
