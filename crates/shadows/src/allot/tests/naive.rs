//! What an allotment must be, said in another way than the code does it: in pixels, with sums from scratch, and with
//! a map of cells that are painted.

use super::*;
use crate::TileRect;

/// Panics if an allotment breaks a rule. The rules must be sound, the wishes finite and their owners unique.
pub(super) fn check(rules: &AllotRules, wishes: &[TileWish], previous: Option<&Allotment>, got: &Allotment) {
    let mut wishes: Vec<TileWish> = wishes.iter().copied().filter(|wish| wish.tiles > 0).collect();
    wishes.sort_by(|a, b| b.importance.partial_cmp(&a.importance).unwrap().then(a.owner.cmp(&b.owner)));
    check_form(rules, got);
    check_who(rules, &wishes, got);
    check_wished(rules, &wishes, previous, got);
    check_shares(rules, &wishes, previous, got);
    check_rank(&wishes, got);
    check_places(rules, previous, got);
}

fn ascending(owners: impl Iterator<Item = u32>) -> bool {
    owners.collect::<Vec<_>>().is_sorted_by(|a, b| a < b)
}

fn check_form(rules: &AllotRules, got: &Allotment) {
    assert!(ascending(got.granted.iter().map(|granted| granted.owner)));
    assert!(ascending(got.refused.iter().copied()));
    assert_eq!(got.granted.iter().map(|granted| granted.tiles).sum::<usize>(), got.rects.len());
    let mut map = Cells::new(rules);
    for (granted, rects) in got.iter() {
        for px in [granted.tile_px, granted.wished_px] {
            assert!(px.is_power_of_two() && px >= rules.smallest_px && px <= rules.largest_px);
        }
        assert_eq!(rects.len(), granted.tiles);
        for rect in rects {
            assert_eq!([rect.width, rect.height], [granted.tile_px; 2]);
            assert_eq!([rect.x % granted.tile_px, rect.y % granted.tile_px], [0, 0]);
            assert!(map.is_free(*rect), "outside of the map or on another: {rect:?}");
            map.paint(*rect);
        }
    }
}

/// Those that fit at the smallest size, from the most important on, are granted; the others are not.
fn check_who(rules: &AllotRules, wishes: &[TileWish], got: &Allotment) {
    let across = rules.map_px / rules.smallest_px;
    let fit = |&n: &usize| wishes[..n].iter().map(|wish| wish.tiles).sum::<u32>() <= across * across;
    let served = (0..=wishes.len()).filter(fit).max().unwrap();
    for (i, wish) in wishes.iter().enumerate() {
        let granted = got.granted_to(wish.owner);
        assert_eq!(granted.is_some(), i < served, "{wish:?}");
        assert_eq!(got.refused.contains(&wish.owner), i >= served, "{wish:?}");
        assert_eq!(granted.map_or(wish.tiles as usize, |granted| granted.tiles), wish.tiles as usize);
    }
    assert_eq!(got.granted.len() + got.refused.len(), wishes.len());
}

fn check_wished(rules: &AllotRules, wishes: &[TileWish], previous: Option<&Allotment>, got: &Allotment) {
    for wish in wishes {
        let Some(granted) = got.granted_to(wish.owner) else { continue };
        let px = wish.size_px.max(rules.smallest_px.into()).min(rules.largest_px.into());
        let off = |wished: u32| (px / f64::from(wished)).log2().abs();
        let before = previous.and_then(|previous| previous.granted_to(wish.owner));
        match before.filter(|before| off(before.wished_px) < 1.0) {
            Some(before) => assert_eq!(granted.wished_px, before.wished_px, "{wish:?}"),
            None => assert!(off(granted.wished_px) < 0.5 + 1e-9, "{wish:?} {granted:?}"),
        }
    }
}

/// The sizes are those of a state on the way from all at the smallest to all as wished, and the way on is barred.
fn check_shares(rules: &AllotRules, wishes: &[TileWish], previous: Option<&Allotment>, got: &Allotment) {
    let granted: Vec<&Granted> = wishes.iter().filter_map(|wish| got.granted_to(wish.owner)).collect();
    let sizes: Vec<u32> = granted.iter().map(|granted| granted.tile_px).collect();
    let area = u64::from(rules.map_px).pow(2);
    let total = |sizes: &[u32]| -> u64 {
        sizes.iter().zip(&granted).map(|(&px, granted)| u64::from(px).pow(2) * granted.tiles as u64).sum()
    };
    let mut state = vec![rules.smallest_px; granted.len()];
    let mut reached = state == sizes;
    for halvings in (0..32).rev() {
        for (i, owner) in granted.iter().enumerate() {
            let mut next = state.clone();
            next[i] = (owner.wished_px >> halvings).max(rules.smallest_px);
            if next == state {
                continue;
            }
            let fits = if halvings_before(previous, owner.owner) > halvings {
                10 * total(&next) <= 9 * area && got.refused.is_empty()
            } else {
                total(&next) <= area
            };
            assert!(fits || reached, "smaller than it should be: {sizes:?}");
            if !fits {
                return;
            }
            assert!(!reached, "more would have fitted: {sizes:?} {next:?}");
            state = next;
            reached = state == sizes;
        }
    }
    assert!(reached, "not a state on the way: {sizes:?}");
}

fn halvings_before(previous: Option<&Allotment>, owner: u32) -> u32 {
    let before = previous.and_then(|previous| previous.granted_to(owner));
    before.map_or(0, |before| (before.wished_px / before.tile_px).trailing_zeros())
}

/// Of two with the same wish the more important is not the smaller.
fn check_rank(wishes: &[TileWish], got: &Allotment) {
    let granted: Vec<&Granted> = wishes.iter().filter_map(|wish| got.granted_to(wish.owner)).collect();
    for (i, less) in granted.iter().enumerate() {
        for more in granted[..i].iter().filter(|more| more.wished_px == less.wished_px) {
            assert!(more.tile_px >= less.tile_px, "{more:?} {less:?}");
        }
    }
}

fn check_places(rules: &AllotRules, previous: Option<&Allotment>, got: &Allotment) {
    let mut places: Vec<Option<TileRect>> = Vec::new();
    for granted in &got.granted {
        let before = previous.and_then(|previous| previous.granted_to(granted.owner));
        let stays = before.is_some_and(|before| before.tile_px == granted.tile_px);
        let before = previous.filter(|_| stays).map_or(&[][..], |all| all.rects_of(granted.owner));
        places.extend((0..granted.tiles).map(|i| before.get(i).copied()));
    }
    let widths: Vec<u32> = got.rects.iter().map(|rect| rect.width).collect();
    let mut map = Cells::new(rules);
    places.iter().flatten().for_each(|&rect| map.paint(rect));
    let homeless = |places: &[Option<TileRect>]| -> Vec<u32> {
        (0..places.len()).filter(|&i| places[i].is_none()).map(|i| widths[i]).collect()
    };
    let in_pieces = !map.can_hold(&homeless(&places));
    assert_eq!(got.repacked, in_pieces);
    if in_pieces {
        places.fill(None);
        map = Cells::new(rules);
        assert!(map.can_hold(&widths));
    }
    map.fill(&widths, &mut places);
    let places: Vec<TileRect> = places.into_iter().map(Option::unwrap).collect();
    assert_eq!(places, got.rects);
}

/// A map whose cells are painted where a tile lies.
pub(super) struct Cells {
    px: u32,
    across: u32,
    painted: Vec<bool>,
}

impl Cells {
    pub(super) fn new(rules: &AllotRules) -> Self {
        let across = rules.map_px / rules.smallest_px;
        Self { px: rules.smallest_px, across, painted: vec![false; (across * across) as usize] }
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

    /// All aligned squares of a width, in Morton order.
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

    /// Whether there are places for squares of these widths: for each width, as many as all that are at least as wide
    /// take up.
    fn can_hold(&self, widths: &[u32]) -> bool {
        widths.iter().all(|&width| {
            let free = self.squares(width).into_iter().filter(|&square| self.is_free(square)).count() as u32;
            let in_each = |&wider: &u32| (wider / width).pow(2);
            widths.iter().filter(|&&wider| wider >= width).map(in_each).sum::<u32>() <= free
        })
    }

    /// Puts each tile without a place, the biggest first, at the beginning of the first of the smallest free squares
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

/// The square of twice the width, which is not free where it is wider than the map.
fn parent(one: TileRect) -> TileRect {
    let width = 2 * one.width;
    square(one.x / width * width, one.y / width * width, width)
}
