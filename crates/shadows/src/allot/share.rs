//! Who gets how much of the map.

use super::ask::Ask;

/// An owner whose wished size was halved is given a size back only while one part in so many of the map stays free and
/// nobody is refused.
///
/// So a light that takes no more than that, and comes and goes, makes others smaller once at most, and never larger.
pub(crate) const GROWTH_SLACK: u64 = 10;

/// Sets the levels of the asks, the most important first, in a map of `room` cells. Returns how many of them are
/// served; the rest is refused.
pub(super) fn share(room: u64, asks: &mut [Ask]) -> usize {
    let (served, total) = let_in(room, asks);
    // What a refused owner with several tiles leaves free is taken back as soon as it is let in.
    let to_grow = if served == asks.len() { room - room.div_ceil(GROWTH_SLACK) } else { 0 };
    double(Limits { to_stay: room, to_grow }, total, &mut asks[..served]);
    served
}

/// How many cells may be taken once an owner has been given a size.
#[derive(Clone, Copy)]
struct Limits {
    /// For owners that were halved no further than now, and for new ones.
    to_stay: u64,
    /// For owners that were halved further.
    to_grow: u64,
}

/// Returns how many asks fit at the smallest size, up to the first that does not, and how many cells they take.
fn let_in(room: u64, asks: &[Ask]) -> (usize, u64) {
    let mut total = 0;
    for (index, ask) in asks.iter().enumerate() {
        let more = total + ask.cells(0);
        if more > room {
            return (index, total);
        }
        total = more;
    }
    (asks.len(), total)
}

/// Doubles sizes in laps, up to the first that does not fit.
fn double(limits: Limits, mut total: u64, asks: &mut [Ask]) {
    let most = asks.iter().map(|ask| ask.wished).max().unwrap_or(0);
    for halvings in (0..most).rev() {
        for ask in asks.iter_mut() {
            let level = ask.wished.saturating_sub(halvings);
            if level == ask.level {
                continue;
            }
            // The tiles fit at their present level, so only the first of these can be beyond all numbers.
            total = ask.cells(level).saturating_add(total - ask.cells(ask.level));
            let limit = if halvings < ask.halved_before { limits.to_grow } else { limits.to_stay };
            if total > limit {
                return;
            }
            ask.level = level;
        }
    }
}
