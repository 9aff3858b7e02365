//! Too much for the map.

use super::*;

fn equal(owners: std::ops::Range<u32>, tiles: u32, size_px: f64) -> Vec<TileWish> {
    owners.map(|owner| wish(owner, tiles, size_px, -f64::from(owner))).collect()
}

#[test]
fn all_that_fits_is_granted_as_wished() {
    let got = allot(&RULES, &equal(0..4, 1, 256.0), None);
    assert_eq!(sizes(&got), [(0, 256), (1, 256), (2, 256), (3, 256)]);
    assert!(got.refused.is_empty());
}

#[test]
fn one_too_many_halves_the_least_important_first() {
    // Five halves are 5/16 of the map. Each half that is given back takes 3/16 more: three fit.
    let got = allot(&RULES, &equal(0..5, 1, 256.0), None);
    assert_eq!(sizes(&got), [(0, 256), (1, 256), (2, 256), (3, 128), (4, 128)]);
}

#[test]
fn a_size_is_given_back_to_nobody_after_the_first_that_it_does_not_fit_for() {
    // The point light takes 6/16 at 128, so 18/16 more to be 256; the spot light after it would have fitted.
    let got = allot(&RULES, &[wish(0, 6, 256.0, 1.0), wish(1, 1, 256.0, 0.0)], None);
    assert_eq!(sizes(&got), [(0, 128), (1, 128)]);
    let got = allot(&RULES, &[wish(0, 6, 256.0, 0.0), wish(1, 1, 256.0, 1.0)], None);
    assert_eq!(sizes(&got), [(0, 128), (1, 256)]);
}

#[test]
fn only_the_least_important_are_refused() {
    let got = allot(&RULES, &equal(0..50, 6, 256.0), None);
    assert_eq!(got.granted.len(), 42);
    assert_eq!(got.refused, (42..50).collect::<Vec<_>>());
    assert!(got.granted.iter().all(|granted| granted.tile_px == 32));
}

#[test]
fn nobody_passes_a_more_important_owner_that_is_refused() {
    let mut wishes = equal(0..42, 6, 32.0);
    // 252 of 256 cells are taken, so six more do not fit. One more would.
    wishes.extend([wish(60, 6, 32.0, -100.0), wish(61, 1, 32.0, -101.0)]);
    assert_eq!(allot(&RULES, &wishes, None).refused, [60, 61]);
}

#[test]
fn of_equally_important_owners_the_lower_is_served_first() {
    let wishes: Vec<TileWish> = [9, 2, 5, 7, 3].map(|owner| wish(owner, 1, 256.0, 1.0)).to_vec();
    let got = allot(&RULES, &wishes, None);
    assert_eq!(sizes(&got), [(2, 256), (3, 256), (5, 256), (7, 128), (9, 128)]);
}

#[test]
fn a_map_of_4096_has_room_for_64_point_and_64_spot_lights() {
    let rules = AllotRules { map_px: 4096, smallest_px: 32, largest_px: 1024 };
    let light = |owner: u32| wish(owner, if owner < 64 { 6 } else { 1 }, 1024.0, f64::from(owner % 64));
    let wishes: Vec<TileWish> = (0..128).map(light).collect();
    let got = allot(&rules, &wishes, None);
    assert_eq!((got.granted.len(), got.refused.len(), got.rects.len()), (128, 0, 448));
    naive::check(&rules, &wishes, None, &got);
    // 448 tiles of 128 px take 0.4375 of the map. Only a part of them can be 256 px.
    assert!(got.granted.iter().all(|granted| granted.tile_px == 128 || granted.tile_px == 256));
}

proptest! {
    /// The rule as it is told: the fewest halvings of all that fit, and one back for each from the first on.
    #[test]
    fn without_memory_sizes_halve_together_and_the_first_get_one_back((rules, wishes) in rules_and_wishes(40)) {
        let got = allot(&rules, &wishes, None);
        let mut ranked: Vec<&TileWish> = wishes.iter().filter(|wish| got.granted_to(wish.owner).is_some()).collect();
        ranked.sort_by(|a, b| b.importance.total_cmp(&a.importance).then(a.owner.cmp(&b.owner)));
        let granted: Vec<Granted> = ranked.iter().map(|wish| *got.granted_to(wish.owner).unwrap()).collect();
        let size = |one: &Granted, halvings: u32| (one.wished_px >> halvings).max(rules.smallest_px);
        let area = |one: &Granted, halvings: u32| u64::from(size(one, halvings)).pow(2) * one.tiles as u64;
        let room = u64::from(rules.map_px).pow(2);
        let total = |k: u32| granted.iter().map(|one| area(one, k)).sum::<u64>();
        let k = (0..10).find(|&k| total(k) <= room).unwrap();
        let mut left = room - total(k);
        let mut given_back = k > 0;
        for one in &granted {
            let more = if given_back { area(one, k - 1) - area(one, k) } else { 0 };
            given_back &= more <= left;
            left -= if given_back { more } else { 0 };
            prop_assert_eq!(one.tile_px, size(one, if given_back { k - 1 } else { k }));
        }
    }
}
