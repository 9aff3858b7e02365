//! A second implementation of the rules of an allocation: in pixels, with totals computed from scratch, and with
//! a map of cells that are painted.

use super::*;
use crate::atlas::TileRect;

/// Panics if an allocation breaks a rule. The config must be normalized, the requests finite and their owners unique.
pub(super) fn check(
    config: &AtlasConfig,
    requests: &[TileRequest],
    previous: Option<&AtlasAllocation>,
    got: &AtlasAllocation,
) {
    let mut requests: Vec<TileRequest> =
        requests.iter().copied().filter(|request| request.tiles > 0).collect();
    requests.sort_by(|a, b| b.importance.partial_cmp(&a.importance).unwrap().then(a.owner.cmp(&b.owner)));
    check_form(config, got);
    check_admission(config, &requests, got);
    check_requested(config, &requests, previous, got);
    check_sizes(config, &requests, previous, got);
    check_rank(&requests, got);
    check_places(config, previous, got);
}

fn ascending(owners: impl Iterator<Item = u32>) -> bool {
    owners.collect::<Vec<_>>().is_sorted_by(|a, b| a < b)
}

fn check_form(config: &AtlasConfig, got: &AtlasAllocation) {
    assert!(ascending(got.owners.iter().map(|entry| entry.owner)));
    assert!(ascending(got.rejected.iter().copied()));
    assert_eq!(got.owners.iter().map(|entry| entry.tiles).sum::<usize>(), got.rects.len());
    let mut map = Cells::new(config);
    for (entry, rects) in got.iter() {
        for px in [entry.tile_px, entry.requested_px] {
            assert!(px.is_power_of_two() && px >= config.smallest_px && px <= config.largest_px);
        }
        assert_eq!(rects.len(), entry.tiles);
        for rect in rects {
            assert_eq!([rect.width, rect.height], [entry.tile_px; 2]);
            assert_eq!([rect.x % entry.tile_px, rect.y % entry.tile_px], [0, 0]);
            assert!(map.is_free(*rect), "outside the map or overlapping: {rect:?}");
            map.paint(*rect);
        }
    }
}

/// Requests that fit at the smallest size, from the most important on, are admitted; the others are rejected.
fn check_admission(config: &AtlasConfig, requests: &[TileRequest], got: &AtlasAllocation) {
    let across = config.map_px / config.smallest_px;
    let fit = |&n: &usize| requests[..n].iter().map(|request| request.tiles).sum::<u32>() <= across * across;
    let admitted = (0..=requests.len()).filter(fit).max().unwrap();
    for (i, request) in requests.iter().enumerate() {
        let entry = got.for_owner(request.owner);
        assert_eq!(entry.is_some(), i < admitted, "{request:?}");
        assert_eq!(got.rejected.contains(&request.owner), i >= admitted, "{request:?}");
        assert_eq!(entry.map_or(request.tiles as usize, |entry| entry.tiles), request.tiles as usize);
    }
    assert_eq!(got.owners.len() + got.rejected.len(), requests.len());
}

fn check_requested(
    config: &AtlasConfig,
    requests: &[TileRequest],
    previous: Option<&AtlasAllocation>,
    got: &AtlasAllocation,
) {
    for request in requests {
        let Some(entry) = got.for_owner(request.owner) else { continue };
        let px = request.size_px.max(config.smallest_px.into()).min(config.largest_px.into());
        let off = |requested: u32| (px / f64::from(requested)).log2().abs();
        let before = previous.and_then(|previous| previous.for_owner(request.owner));
        match before.filter(|before| off(before.requested_px) < 1.0) {
            Some(before) => assert_eq!(entry.requested_px, before.requested_px, "{request:?}"),
            None => assert!(off(entry.requested_px) < 0.5 + 1e-9, "{request:?} {entry:?}"),
        }
    }
}

/// The sizes are those before the first doubling, from the smallest to the most, that does not fit.
fn check_sizes(
    config: &AtlasConfig,
    requests: &[TileRequest],
    previous: Option<&AtlasAllocation>,
    got: &AtlasAllocation,
) {
    let entries: Vec<&TileAllocation> =
        requests.iter().filter_map(|request| got.for_owner(request.owner)).collect();
    let sizes: Vec<u32> = entries.iter().map(|entry| entry.tile_px).collect();
    let area = u64::from(config.map_px).pow(2);
    let total = |sizes: &[u32]| -> u64 {
        sizes.iter().zip(&entries).map(|(&px, entry)| u64::from(px).pow(2) * entry.tiles as u64).sum()
    };
    let mut state = vec![config.smallest_px; entries.len()];
    'rounds: for halvings in (0..32).rev() {
        for (i, owner) in entries.iter().enumerate() {
            let most = u64::from(owner.requested_px) << config.growth;
            let mut next = state.clone();
            next[i] = (most >> halvings).clamp(config.smallest_px.into(), config.largest_px.into()) as u32;
            let may_grow = 10 * total(&next) <= 9 * area && got.rejected.is_empty();
            let grows = next != state && halvings_before(config, previous, owner.owner) > halvings;
            if total(&next) > area || grows && !may_grow {
                break 'rounds;
            }
            state = next;
        }
    }
    assert_eq!(state, sizes);
}

fn halvings_before(config: &AtlasConfig, previous: Option<&AtlasAllocation>, owner: u32) -> u32 {
    let before = previous.and_then(|previous| previous.for_owner(owner));
    before.map_or(0, |before| ((before.requested_px << config.growth) / before.tile_px).trailing_zeros())
}

/// The more important of two owners that request the same size is not the smaller one.
fn check_rank(requests: &[TileRequest], got: &AtlasAllocation) {
    let entries: Vec<&TileAllocation> =
        requests.iter().filter_map(|request| got.for_owner(request.owner)).collect();
    for (i, less) in entries.iter().enumerate() {
        for more in entries[..i].iter().filter(|more| more.requested_px == less.requested_px) {
            assert!(more.tile_px >= less.tile_px, "{more:?} {less:?}");
        }
    }
}

fn check_places(config: &AtlasConfig, previous: Option<&AtlasAllocation>, got: &AtlasAllocation) {
    let mut places: Vec<Option<TileRect>> = Vec::new();
    for entry in &got.owners {
        let before = previous.and_then(|previous| previous.for_owner(entry.owner));
        let stays = before.is_some_and(|before| before.tile_px == entry.tile_px);
        let before = previous.filter(|_| stays).map_or(&[][..], |all| all.rects_for(entry.owner));
        places.extend((0..entry.tiles).map(|i| before.get(i).copied()));
    }
    let widths: Vec<u32> = got.rects.iter().map(|rect| rect.width).collect();
    let mut map = Cells::new(config);
    places.iter().flatten().for_each(|&rect| map.paint(rect));
    let unplaced = |places: &[Option<TileRect>]| -> Vec<u32> {
        (0..places.len()).filter(|&i| places[i].is_none()).map(|i| widths[i]).collect()
    };
    let fragmented = !map.can_hold(&unplaced(&places));
    assert_eq!(got.repacked, fragmented);
    if fragmented {
        places.fill(None);
        map = Cells::new(config);
        assert!(map.can_hold(&widths));
    }
    map.fill(&widths, &mut places);
    let places: Vec<TileRect> = places.into_iter().map(Option::unwrap).collect();
    assert_eq!(places, got.rects);
}

/// A map in which the cells of tiles are painted.
pub(super) struct Cells {
    px: u32,
    across: u32,
    painted: Vec<bool>,
}

impl Cells {
    pub(super) fn new(config: &AtlasConfig) -> Self {
        let across = config.map_px / config.smallest_px;
        Self { px: config.smallest_px, across, painted: vec![false; (across * across) as usize] }
    }

    fn cells(&self, rect: TileRect) -> impl Iterator<Item = Option<usize>> + use<> {
        let (px, across) = (self.px, self.across);
        let [left, top] = [rect.x / px, rect.y / px];
        let [right, bottom] = [left + rect.width / px, top + rect.height / px];
        let inside = right <= across && bottom <= across;
        let cell = move |y, x| inside.then_some((y * across + x) as usize);
        (top..bottom).flat_map(move |y| (left..right).map(move |x| cell(y, x)))
    }

    pub(super) fn is_free(&self, rect: TileRect) -> bool {
        self.cells(rect).all(|cell| cell.is_some_and(|cell| !self.painted[cell]))
    }

    pub(super) fn paint(&mut self, rect: TileRect) {
        self.cells(rect).for_each(|cell| self.painted[cell.unwrap()] = true);
    }

    /// Returns all aligned squares of a width, in Morton order.
    fn squares(&self, width: u32) -> Vec<TileRect> {
        let n = self.across * self.px / width;
        let mut squares: Vec<TileRect> =
            (0..n * n).map(|i| square(i % n * width, i / n * width, width)).collect();
        squares.sort_by_cached_key(|square| {
            let bit = |at: u32, bit: u32| u64::from(at / self.px / (1 << bit) % 2);
            (0..8).map(|i| bit(square.x, i) << (2 * i) | bit(square.y, i) << (2 * i + 1)).sum::<u64>()
        });
        squares
    }

    /// Returns whether squares of these widths fit: for each width, as many as all that are at least as wide
    /// take up.
    fn can_hold(&self, widths: &[u32]) -> bool {
        widths.iter().all(|&width| {
            let free = self.squares(width).into_iter().filter(|&square| self.is_free(square)).count() as u32;
            let in_each = |&wider: &u32| (wider / width).pow(2);
            widths.iter().filter(|&&wider| wider >= width).map(in_each).sum::<u32>() <= free
        })
    }

    /// Places each unplaced tile, largest first, at the beginning of the first of the smallest free squares
    /// that are no part of a larger one.
    fn fill(&mut self, widths: &[u32], places: &mut [Option<TileRect>]) {
        let mut order: Vec<usize> = (0..places.len()).filter(|&i| places[i].is_none()).collect();
        order.sort_by(|&a, &b| widths[b].cmp(&widths[a]));
        for i in order {
            let doubles = std::iter::successors(Some(widths[i]), |px| Some(2 * px));
            let first = doubles.take_while(|&px| px <= self.across * self.px).find_map(|px| {
                self.squares(px).into_iter().find(|&one| self.is_free(one) && !self.is_free(parent(one)))
            });
            let first = first.unwrap();
            places[i] = Some(square(first.x, first.y, widths[i]));
            self.paint(places[i].unwrap());
        }
    }
}

fn square(x: u32, y: u32, width: u32) -> TileRect {
    TileRect { x, y, width, height: width }
}

/// Returns the square of twice the width, which is not free where it is wider than the map.
fn parent(one: TileRect) -> TileRect {
    let width = 2 * one.width;
    square(one.x / width * width, one.y / width * width, width)
}
