//! Sizes and who is refused, from frame to frame.

use super::*;

/// Allots frame after frame, and returns all allotments from the given one on.
fn run(rules: &AllotRules, start: &Allotment, frames: impl Iterator<Item = Vec<TileWish>>) -> Vec<Allotment> {
    let mut all = vec![start.clone()];
    for wishes in frames {
        all.push(allot(rules, &wishes, all.last()));
    }
    all
}

#[test]
fn a_small_light_that_comes_and_goes_makes_another_smaller_only_once() {
    // Three quarters of the map are taken at wished size, with the last light all of it.
    let base: Vec<TileWish> = (0..4).map(|owner| wish(owner, 1, 256.0, -f64::from(owner))).collect();
    let with: Vec<TileWish> = base.iter().copied().chain([wish(9, 1, 128.0, 9.0)]).collect();
    let start = allot(&RULES, &base, None);
    let frames = (0..10).map(|frame| if frame % 2 == 0 { with.clone() } else { base.clone() });
    let all = run(&RULES, &start, frames);
    assert_eq!(size_of(&all[0], 3), Some(256));
    assert!(all[1..].iter().all(|got| size_of(got, 3) == Some(128)));
}

#[test]
fn what_was_halved_grows_again_once_a_tenth_of_the_map_stays_free() {
    let base = [wish(0, 12, 128.0, 9.0), wish(1, 1, 128.0, 0.0), wish(2, 20, 32.0, 1.0)];
    let crowd = |more: u32| base.iter().copied().chain([wish(3, more, 32.0, 1.0)]).collect::<Vec<_>>();
    // Of 256 cells 12 * 16 + 20 are taken. The last light takes 16 or 4 of the 44 that are left: 29 more are too many.
    let halved = allot(&RULES, &crowd(29), None);
    assert_eq!(size_of(&halved, 1), Some(64));
    assert_eq!(size_of(&allot(&RULES, &crowd(28), None), 1), Some(128));
    // 228 + 3 = 231 cells are more than nine tenths of the map, 230 are less.
    assert_eq!(size_of(&allot(&RULES, &crowd(3), Some(&halved)), 1), Some(64));
    assert_eq!(size_of(&allot(&RULES, &crowd(2), Some(&halved)), 1), Some(128));
}

#[test]
fn nobody_grows_into_what_a_refused_owner_leaves_free() {
    // Owner 0 wishes for four cells. Owner 9 is the last and needs 32.
    let lights = |more: u32| {
        let others = (1..8).map(|owner| wish(owner, if owner < 7 { 32 } else { more }, 32.0, 1.0));
        others.chain([wish(0, 1, 64.0, 2.0), wish(9, 32, 32.0, 0.0)]).collect::<Vec<_>>()
    };
    let full = allot(&RULES, &lights(31), None);
    assert_eq!((full.rects.len(), size_of(&full, 0), full.refused.len()), (256, Some(32), 0));
    // One cell more, and 31 are free: three more would leave 28 of 256, more than a tenth.
    let crowded = allot(&RULES, &lights(32), Some(&full));
    assert_eq!((crowded.rects.len(), size_of(&crowded, 0), &crowded.refused[..]), (225, Some(32), &[9][..]));
    // Without memory it does grow, and stays so.
    let first = allot(&RULES, &lights(32), None);
    assert_eq!(size_of(&first, 0), Some(64));
    assert_eq!(size_of(&allot(&RULES, &lights(32), Some(&first)), 0), Some(64));
}

#[test]
fn a_refused_owner_is_granted_as_soon_as_it_fits() {
    let mut wishes: Vec<TileWish> = (0..43).map(|owner| wish(owner, 6, 32.0, -f64::from(owner))).collect();
    let crowded = allot(&RULES, &wishes, None);
    assert_eq!(crowded.refused, [42]);
    // 252 cells are taken, 4 are left, and 2 become free.
    wishes[3].tiles = 4;
    let got = allot(&RULES, &wishes, Some(&crowded));
    assert!(got.refused.is_empty());
    assert_eq!(got.rects.len(), 256);
}

proptest! {
    #[test]
    fn the_same_wishes_again_change_nothing((rules, wishes, before) in with_memory(30)) {
        let once = allot(&rules, &wishes, Some(&before));
        let again = allot(&rules, &wishes, Some(&once));
        prop_assert_eq!(&again, &Allotment { repacked: false, ..once });
    }

    #[test]
    fn a_wish_that_swings_by_a_tenth_changes_sizes_once_at_most(
        (rules, wishes, before) in with_memory(20),
        who in any::<prop::sample::Index>(),
        swings in prop::collection::vec(prop_oneof![Just(0.9), Just(1.1), 0.9_f64..1.1], 20),
    ) {
        prop_assume!(!wishes.is_empty());
        let who = who.index(wishes.len());
        let settled = allot(&rules, &wishes, Some(&before));
        let frames = swings.into_iter().map(|swing| {
            let mut wishes = wishes.clone();
            wishes[who].size_px *= swing;
            wishes
        });
        let all = run(&rules, &settled, frames);
        let changes = all.windows(2).filter(|pair| sizes(&pair[0]) != sizes(&pair[1])).count();
        prop_assert!(changes <= 1, "{changes}");
    }

    #[test]
    fn a_lone_wish_that_swings_by_a_tenth_changes_its_size_once_at_most(
        first in 10.0_f64..1000.0,
        around in 10.0_f64..1000.0,
        swings in prop::collection::vec(prop_oneof![Just(0.9), Just(1.1), 0.9_f64..1.1], 20),
    ) {
        let start = allot(&RULES, &[wish(0, 1, first, 0.0)], None);
        let all = run(&RULES, &start, swings.into_iter().map(|swing| vec![wish(0, 1, around * swing, 0.0)]));
        let changes = all.windows(2).filter(|pair| sizes(&pair[0]) != sizes(&pair[1])).count();
        prop_assert!(changes <= 1, "{changes}");
    }

    #[test]
    fn a_light_of_a_tenth_of_the_map_that_comes_and_goes_changes_sizes_once_at_most(
        (rules, mut wishes, before) in with_memory(30),
        size in any_size(),
        importance in any_importance(),
    ) {
        let visitor = wish(1000, 1, f64::from(rules.smallest_px) * size.exp2(), importance);
        let alone = allot(&rules, &[visitor], None);
        prop_assume!(10 * u64::from(alone.rects[0].width).pow(2) <= u64::from(rules.map_px).pow(2));
        let start = allot(&rules, &wishes, Some(&before));
        let without = wishes.clone();
        wishes.push(visitor);
        let frames = (0..8).map(|frame| if frame % 2 == 0 { wishes.clone() } else { without.clone() });
        let all = run(&rules, &start, frames);
        // Owners that are refused when it comes are let in again when it goes, whatever that means.
        for granted in all[1].granted.iter().filter(|granted| granted.owner != 1000) {
            prop_assert!(size_of(&all[0], granted.owner).unwrap() >= granted.tile_px);
            for later in &all[2..] {
                prop_assert_eq!(size_of(later, granted.owner), Some(granted.tile_px));
            }
        }
    }
}
