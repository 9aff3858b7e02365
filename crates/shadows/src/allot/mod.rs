//! The allotment of a square map: tiles sized by importance, in places that stay.
//!
//! [`allot`] is a pure function. Its memory is the [`Allotment`] of the frame before. It goes in four steps:
//!
//! 1. *Wished sizes.* Each wish is rounded to the nearest power of two, unless the size that the owner wished for
//!    before is still less than a factor of 2 away.
//! 2. *Refusals.* With every tile at the smallest size, owners are let in from the most important on, up to the
//!    first that does not fit. That one and all after it are refused. Memory plays no part in it.
//! 3. *Halvings.* Every owner that was let in begins at the smallest size and gets its wished size back by
//!    doublings: in laps of one doubling each, within a lap from the most important on, up to the first that
//!    does not fit. So all sizes are halved k times or k - 1 times, and k - 1 times for the most important ones.
//!    An owner that had been halved further in the frame before grows only while a tenth of the map
//!    stays free and nobody is refused.
//! 4. *Places.* Owners keep their places while their size stays. The others are put into free places, biggest
//!    first, each into the smallest free block that holds it. Only if that fails is everything placed anew.
//!
//! What memory costs: if somebody has less than wished and nobody is refused, less of the map is free than the slack
//! and the next doubling together; without memory, less than that doubling. Importance has no memory here: two owners that
//! change places in it from frame to frame may change sizes too, since the more important one is never to be the smaller
//! one.
//!
//! A place is a *block*: an aligned square that is a power of two wide. Along the Morton curve (Z-order curve) each
//! block is an interval of cells that begins at a multiple of its length, which is a power of four. So the map is
//! handled as a line.

mod allotment;
mod ask;
mod blocks;
mod levels;
mod morton;
mod place;
mod rules;
mod share;
#[cfg(test)]
mod tests;
mod wish;

use ask::Ask;
use levels::Levels;

pub use allotment::{Allotment, Granted};
pub use rules::AllotRules;
pub use wish::TileWish;

/// Grants the wishes tiles in a square map, close to what the allotment of the frame before granted.
///
/// The order of `wishes` does not matter. `previous` is ignored if it was made with other rules.
///
/// ```
/// use shadowgraph_shadows::{AllotRules, TileWish, allot};
/// let rules = AllotRules { map_px: 1024, smallest_px: 32, largest_px: 512 };
/// let point = TileWish { owner: 3, tiles: 6, size_px: 230.0, importance: 1.0 };
/// let spot = TileWish { owner: 1, tiles: 1, size_px: 600.0, importance: 0.5 };
/// let allotment = allot(&rules, &[point, spot], None);
/// assert_eq!(allotment.rects_of(3).len(), 6);
/// assert_eq!(allotment.rects_of(3)[0].width, 256);
/// assert_eq!(allotment.rects_of(1)[0].width, 512);
/// // The next frame, a little farther away.
/// let point = TileWish { size_px: 170.0, ..point };
/// assert_eq!(allot(&rules, &[spot, point], Some(&allotment)).rects, allotment.rects);
/// ```
#[must_use]
pub fn allot(rules: &AllotRules, wishes: &[TileWish], previous: Option<&Allotment>) -> Allotment {
    let wishes = wish::clean(wishes);
    let Some(levels) = Levels::new(rules) else {
        return Allotment { refused: wishes.iter().map(|wish| wish.owner).collect(), ..Allotment::default() };
    };
    let (wishes, excessive): (Vec<_>, Vec<_>) =
        wishes.into_iter().partition(|wish| wish.tiles <= wish::MAX_TILES);
    let previous = previous.filter(|previous| previous.rules == levels.rules());
    let mut asks: Vec<Ask> = wishes.iter().map(|wish| Ask::new(&levels, wish, previous)).collect();
    asks.sort_unstable_by(Ask::most_important_first);
    let served = share::share(levels.cells(levels.map()), &mut asks);
    let mut refused: Vec<u32> = excessive.iter().map(|wish| wish.owner).collect();
    refused.extend(asks.drain(served..).map(|ask| ask.owner));
    refused.sort_unstable();
    asks.sort_unstable_by_key(|ask| ask.owner);
    let places = place::place(&levels, &asks, previous);
    Allotment {
        granted: allotment::granted(&levels, &asks),
        rects: places.rects,
        refused,
        repacked: places.repacked,
        rules: levels.rules(),
    }
}
