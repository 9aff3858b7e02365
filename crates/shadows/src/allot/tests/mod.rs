//! Allotments of random lights against a checker that paints cells.
#![allow(clippy::unwrap_used, reason = "tests")]

mod frames;
mod naive;
mod places;
mod share;
mod sizes;
mod soundness;
mod steadiness;

use proptest::prelude::*;

use super::*;

const RULES: AllotRules = AllotRules { map_px: 512, smallest_px: 32, largest_px: 256 };

fn wish(owner: u32, tiles: u32, size_px: f64, importance: f64) -> TileWish {
    TileWish { owner, tiles, size_px, importance }
}

fn size_of(allotment: &Allotment, owner: u32) -> Option<u32> {
    allotment.granted_to(owner).map(|granted| granted.tile_px)
}

fn sizes(allotment: &Allotment) -> Vec<(u32, u32)> {
    allotment.granted.iter().map(|granted| (granted.owner, granted.tile_px)).collect()
}

/// Maps of up to 16 by 16 cells.
fn any_rules() -> impl Strategy<Value = AllotRules> {
    let levels = prop_oneof![1 => (0_u32..=4, 0_u32..=4), 3 => (3_u32..=4, 1_u32..=3)];
    (0_u32..=5, levels).prop_map(|(smallest, (map, largest))| AllotRules {
        map_px: 1 << (smallest + map),
        smallest_px: 1 << smallest,
        largest_px: 1 << (smallest + largest.min(map)),
    })
}

/// Sizes as logarithms relative to the smallest size: below, within and above what the rules allow.
fn any_size() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -1.0_f64..5.0, 1 => (-1_i32..5).prop_map(f64::from)]
}

/// Often the same as another's.
fn any_importance() -> impl Strategy<Value = f64> {
    prop_oneof![-1.0_f64..1.0, (-1_i32..=1).prop_map(f64::from)]
}

fn any_tiles() -> impl Strategy<Value = u32> {
    prop_oneof![3 => Just(1_u32), 2 => Just(6), 1 => 0_u32..=8]
}

/// Wishes with sizes in pixels, owners not in order and not all in use.
fn any_wishes(rules: AllotRules, most: usize) -> impl Strategy<Value = Vec<TileWish>> {
    let one = (any_tiles(), any_size(), any_importance());
    proptest::collection::vec(one, 0..=most).prop_map(move |wishes| {
        let with_owner = |(i, (tiles, size, importance)): (usize, (u32, f64, f64))| {
            let owner = (i as u32 * 7 + 3) % 64;
            wish(owner, tiles, f64::from(rules.smallest_px) * size.exp2(), importance)
        };
        wishes.into_iter().enumerate().map(with_owner).collect()
    })
}

fn rules_and_wishes(most: usize) -> impl Strategy<Value = (AllotRules, Vec<TileWish>)> {
    any_rules().prop_flat_map(move |rules| (Just(rules), any_wishes(rules, most)))
}

/// Wishes, and an allotment with the same rules and other wishes of the same owners to remember.
fn with_memory(most: usize) -> impl Strategy<Value = (AllotRules, Vec<TileWish>, Allotment)> {
    let two = move |rules| (Just(rules), any_wishes(rules, most), any_wishes(rules, most));
    any_rules().prop_flat_map(two).prop_map(|(rules, wishes, before)| {
        let crowded = allot(&rules, &before, None);
        let fewer = before.get(before.len() / 3..).unwrap_or(&[]);
        (rules, wishes, allot(&rules, fewer, Some(&crowded)))
    })
}
