//! Any input at all.

use super::*;
use crate::TileRect;

const ODD: [f64; 9] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, -1.0, f64::MAX, f64::MIN_POSITIVE, 100.0];

fn any_f64() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(&ODD[..]), any::<f64>(), 1.0_f64..1000.0]
}

fn any_px() -> impl Strategy<Value = u32> {
    prop_oneof![0_u32..5000, prop::sample::select(&[0, 1, 4096, u32::MAX, 1 << 31][..])]
}

fn odd_rules() -> impl Strategy<Value = AllotRules> {
    let rules = |(map_px, smallest_px, largest_px)| AllotRules { map_px, smallest_px, largest_px };
    (any_px(), any_px(), any_px()).prop_map(rules)
}

fn odd_wishes() -> impl Strategy<Value = Vec<TileWish>> {
    let tiles = prop_oneof![9 => 0_u32..=40, 1 => Just(u32::MAX)];
    let one = (0_u32..30, tiles, any_f64(), any_f64());
    let make = |(owner, tiles, size_px, importance)| TileWish { owner, tiles, size_px, importance };
    prop::collection::vec(one.prop_map(make), 0..30)
}

fn bits(wishes: &[TileWish]) -> Vec<(u32, u32, u64, u64)> {
    wishes.iter().map(|w| (w.owner, w.tiles, w.size_px.to_bits(), w.importance.to_bits())).collect()
}

/// Tiles are aligned, in the map and apart. Unlike the painted cells, for maps of any size.
fn check_apart(rules: &AllotRules, got: &Allotment) {
    for (i, a) in got.rects.iter().enumerate() {
        assert!(a.width == a.height && a.width.is_power_of_two() && a.width <= rules.largest_px.max(1));
        assert!(a.x + (a.width - 1) < rules.map_px && a.y + (a.height - 1) < rules.map_px);
        let apart =
            |a: u32, a_len: u32, b: u32, b_len: u32| a.max(b) - a.min(b) >= if a < b { a_len } else { b_len };
        for b in &got.rects[..i] {
            assert!(apart(a.x, a.width, b.x, b.width) || apart(a.y, a.height, b.y, b.height), "{a:?} {b:?}");
        }
    }
}

#[test]
fn what_is_not_finite_is_the_smallest_and_the_least_important() {
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let got = allot(&RULES, &[wish(0, 1, odd, 0.0)], None);
        assert_eq!(size_of(&got, 0), Some(32));
        let mut wishes: Vec<TileWish> = (1..6).map(|owner| wish(owner, 1, 256.0, f64::MIN)).collect();
        wishes[1].importance = odd;
        let got = allot(&RULES, &wishes, None);
        assert_eq!(sizes(&got), [(1, 256), (2, 128), (3, 256), (4, 256), (5, 128)]);
    }
}

#[test]
fn negative_zero_is_as_important_as_zero() {
    let wishes: Vec<TileWish> =
        (0..5).map(|owner| wish(owner, 1, 256.0, if owner == 0 { -0.0 } else { 0.0 })).collect();
    assert_eq!(size_of(&allot(&RULES, &wishes, None), 0), Some(256));
}

#[test]
fn of_wishes_with_the_same_owner_the_most_important_counts() {
    let got = allot(&RULES, &[wish(0, 1, 64.0, 1.0), wish(0, 2, 128.0, 2.0), wish(0, 3, 256.0, 0.0)], None);
    assert_eq!((sizes(&got), got.rects.len()), (vec![(0, 128)], 2));
}

#[test]
fn a_wish_for_no_tile_is_left_out() {
    let got = allot(&RULES, &[wish(0, 0, 64.0, 0.0), wish(1, 1, 64.0, 0.0)], None);
    assert_eq!((sizes(&got), got.refused.len()), (vec![(1, 64)], 0));
}

#[test]
fn a_wish_for_more_tiles_than_anybody_gets_is_refused_and_stands_in_nobodys_way() {
    let got = allot(&RULES, &[wish(0, 33, 32.0, 9.0), wish(1, 32, 64.0, 0.0), wish(2, 1, 32.0, -1.0)], None);
    assert_eq!((sizes(&got), got.refused), (vec![(1, 64), (2, 32)], vec![0]));
    let huge = AllotRules { map_px: u32::MAX, smallest_px: 1, largest_px: 1 };
    assert_eq!(allot(&huge, &[wish(0, u32::MAX, 1.0, 0.0)], None).refused, [0]);
}

#[test]
fn rules_that_are_no_powers_of_two_are_rounded_down() {
    let wishes: Vec<TileWish> = (0..9).map(|owner| wish(owner, 1 + owner % 6, 90.0, 0.0)).collect();
    let odd = AllotRules { map_px: 1023, smallest_px: 63, largest_px: 300 };
    let even = AllotRules { map_px: 512, smallest_px: 32, largest_px: 256 };
    assert_eq!(allot(&odd, &wishes, None), allot(&even, &wishes, None));
    let wider = AllotRules { map_px: 512, smallest_px: 2048, largest_px: 1024 };
    let one = AllotRules { map_px: 512, smallest_px: 512, largest_px: 512 };
    assert_eq!(allot(&wider, &wishes, None), allot(&one, &wishes, None));
    let none = AllotRules { map_px: 512, smallest_px: 0, largest_px: 0 };
    assert!(allot(&none, &wishes, None).rects.iter().all(|rect| rect.width == 1));
}

#[test]
fn in_a_map_without_pixels_all_are_refused() {
    let wishes = [wish(4, 1, 64.0, 0.0), wish(2, 0, 64.0, 0.0), wish(1, 6, 64.0, 0.0)];
    let got = allot(&AllotRules { map_px: 0, ..RULES }, &wishes, None);
    assert_eq!((got.refused, got.granted.len()), (vec![1, 4], 0));
}

#[test]
fn memory_of_a_place_beyond_all_maps_is_ignored() {
    let rules = AllotRules { map_px: 8, smallest_px: 1, largest_px: 1 };
    let one = [wish(0, 1, 1.0, 0.0)];
    let before = allot(&rules, &one, None);
    let mut harmed = before.clone();
    harmed.rects[0] = TileRect { x: u32::MAX, y: u32::MAX, ..before.rects[0] };
    assert_eq!(allot(&rules, &one, Some(&harmed)), before);
}

#[test]
fn no_wishes_give_an_empty_allotment() {
    let got = allot(&RULES, &[], None);
    assert_eq!((got.granted.len(), got.rects.len(), got.refused.len(), got.repacked), (0, 0, 0, false));
}

proptest! {
    #[test]
    fn no_input_makes_it_fail(
        rules in odd_rules(),
        wishes in odd_wishes(),
        later in odd_wishes(),
    ) {
        let first = allot(&rules, &wishes, None);
        let second = allot(&rules, &later, Some(&first));
        for (got, wishes) in [(&first, &wishes), (&second, &later)] {
            check_apart(&rules, got);
            let mut owners: Vec<u32> = wishes.iter().filter(|w| w.tiles > 0).map(|w| w.owner).collect();
            owners.sort_unstable();
            owners.dedup();
            let mut answered: Vec<u32> = got.granted.iter().map(|granted| granted.owner).collect();
            answered.extend(&got.refused);
            answered.sort_unstable();
            prop_assert_eq!(answered, owners);
        }
    }

    #[test]
    fn the_order_of_wishes_does_not_matter(
        (rules, wishes, shuffled) in (odd_rules(), odd_wishes()).prop_flat_map(|(rules, wishes)| {
            (Just(rules), Just(wishes.clone()), Just(wishes).prop_shuffle())
        }),
        before in odd_wishes(),
    ) {
        let before = allot(&rules, &before, None);
        for previous in [None, Some(&before)] {
            let (a, b) = (allot(&rules, &wishes, previous), allot(&rules, &shuffled, previous));
            prop_assert_eq!(a, b, "{:?}", bits(&shuffled));
        }
    }

    #[test]
    fn in_a_crowd_the_order_of_wishes_does_not_matter(
        (rules, wishes, shuffled, before) in with_memory(30).prop_flat_map(|(rules, wishes, before)| {
            (Just(rules), Just(wishes.clone()), Just(wishes).prop_shuffle(), Just(before))
        }),
    ) {
        prop_assert_eq!(allot(&rules, &wishes, Some(&before)), allot(&rules, &shuffled, Some(&before)));
    }

    #[test]
    fn memory_that_was_changed_by_hand_makes_no_tiles_overlap(
        wishes in any_wishes(RULES, 20),
        from in any::<prop::sample::Index>(),
        to in any::<prop::sample::Index>(),
        harm in 0..7,
    ) {
        let whole = allot(&RULES, &wishes, None);
        prop_assume!(!whole.rects.is_empty());
        let mut harmed = whole.clone();
        let (from, to) = (from.index(whole.rects.len()), to.index(whole.rects.len()));
        match harm {
            0 => harmed.rects[to] = whole.rects[from],
            1 => harmed.rects[to].x += RULES.smallest_px,
            2 => harmed.rects[to].y += 1,
            3 => harmed.rects[to].x = RULES.map_px,
            4 => harmed.rects[to].y = 1 << 31,
            5 => harmed.rects.truncate(to),
            _ => harmed.granted[0] = Granted { tile_px: 0, wished_px: 0, ..harmed.granted[0] },
        }
        let got = allot(&RULES, &wishes, Some(&harmed));
        check_apart(&RULES, &got);
        prop_assert_eq!(got.rects.len(), whole.rects.len());
    }
}
