//! Arbitrary inputs.

use super::*;
use crate::atlas::TileRect;

const ODD: [f64; 9] =
    [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, -1.0, f64::MAX, f64::MIN_POSITIVE, 100.0];

fn any_f64() -> impl Strategy<Value = f64> {
    prop_oneof![prop::sample::select(&ODD[..]), any::<f64>(), 1.0_f64..1000.0]
}

fn any_px() -> impl Strategy<Value = u32> {
    prop_oneof![0_u32..5000, prop::sample::select(&[0, 1, 4096, u32::MAX, 1 << 31][..])]
}

fn odd_config() -> impl Strategy<Value = AtlasConfig> {
    let config =
        |(map_px, smallest_px, largest_px)| AtlasConfig { map_px, smallest_px, largest_px, growth: 0 };
    (any_px(), any_px(), any_px()).prop_map(config)
}

fn odd_requests() -> impl Strategy<Value = Vec<TileRequest>> {
    let tiles = prop_oneof![9 => 0_u32..=40, 1 => Just(u32::MAX)];
    let one = (0_u32..30, tiles, any_f64(), any_f64());
    let make = |(owner, tiles, size_px, importance)| TileRequest { owner, tiles, size_px, importance };
    prop::collection::vec(one.prop_map(make), 0..30)
}

fn bits(requests: &[TileRequest]) -> Vec<(u32, u32, u64, u64)> {
    requests.iter().map(|w| (w.owner, w.tiles, w.size_px.to_bits(), w.importance.to_bits())).collect()
}

/// Tiles are aligned, inside the map and disjoint. Unlike the painted cells, this works for maps of any size.
fn check_apart(config: &AtlasConfig, got: &AtlasAllocation) {
    for (i, a) in got.rects.iter().enumerate() {
        assert!(a.width == a.height && a.width.is_power_of_two() && a.width <= config.largest_px.max(1));
        assert!(a.x + (a.width - 1) < config.map_px && a.y + (a.height - 1) < config.map_px);
        let apart =
            |a: u32, a_len: u32, b: u32, b_len: u32| a.max(b) - a.min(b) >= if a < b { a_len } else { b_len };
        for b in &got.rects[..i] {
            assert!(apart(a.x, a.width, b.x, b.width) || apart(a.y, a.height, b.y, b.height), "{a:?} {b:?}");
        }
    }
}

#[test]
fn values_that_are_not_finite_count_as_smallest_and_least_important() {
    for odd in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let got = allocate_tiles(&CONFIG, &[request(0, 1, odd, 0.0)], None);
        assert_eq!(size_of(&got, 0), Some(32));
        let mut requests: Vec<TileRequest> = (1..6).map(|owner| request(owner, 1, 256.0, f64::MIN)).collect();
        requests[1].importance = odd;
        let got = allocate_tiles(&CONFIG, &requests, None);
        assert_eq!(sizes(&got), [(1, 256), (2, 128), (3, 256), (4, 256), (5, 128)]);
    }
}

#[test]
fn negative_zero_is_as_important_as_zero() {
    let requests: Vec<TileRequest> =
        (0..5).map(|owner| request(owner, 1, 256.0, if owner == 0 { -0.0 } else { 0.0 })).collect();
    assert_eq!(size_of(&allocate_tiles(&CONFIG, &requests, None), 0), Some(256));
}

#[test]
fn of_requests_with_the_same_owner_the_most_important_counts() {
    let got = allocate_tiles(
        &CONFIG,
        &[request(0, 1, 64.0, 1.0), request(0, 2, 128.0, 2.0), request(0, 3, 256.0, 0.0)],
        None,
    );
    assert_eq!((sizes(&got), got.rects.len()), (vec![(0, 128)], 2));
}

#[test]
fn a_request_for_no_tile_is_ignored() {
    let got = allocate_tiles(&CONFIG, &[request(0, 0, 64.0, 0.0), request(1, 1, 64.0, 0.0)], None);
    assert_eq!((sizes(&got), got.rejected.len()), (vec![(1, 64)], 0));
}

#[test]
fn a_request_for_more_tiles_than_allowed_is_rejected_and_affects_nobody() {
    let got = allocate_tiles(
        &CONFIG,
        &[request(0, 33, 32.0, 9.0), request(1, 32, 64.0, 0.0), request(2, 1, 32.0, -1.0)],
        None,
    );
    assert_eq!((sizes(&got), got.rejected), (vec![(1, 64), (2, 32)], vec![0]));
    let huge = AtlasConfig { map_px: u32::MAX, smallest_px: 1, largest_px: 1, growth: 0 };
    assert_eq!(allocate_tiles(&huge, &[request(0, u32::MAX, 1.0, 0.0)], None).rejected, [0]);
}

#[test]
fn sizes_that_are_no_powers_of_two_are_rounded_down() {
    let requests: Vec<TileRequest> = (0..9).map(|owner| request(owner, 1 + owner % 6, 90.0, 0.0)).collect();
    let odd = AtlasConfig { map_px: 1023, smallest_px: 63, largest_px: 300, growth: 0 };
    let even = AtlasConfig { map_px: 512, smallest_px: 32, largest_px: 256, growth: 0 };
    assert_eq!(allocate_tiles(&odd, &requests, None), allocate_tiles(&even, &requests, None));
    let wider = AtlasConfig { map_px: 512, smallest_px: 2048, largest_px: 1024, growth: 0 };
    let one = AtlasConfig { map_px: 512, smallest_px: 512, largest_px: 512, growth: 0 };
    assert_eq!(allocate_tiles(&wider, &requests, None), allocate_tiles(&one, &requests, None));
    let none = AtlasConfig { map_px: 512, smallest_px: 0, largest_px: 0, growth: 0 };
    assert!(allocate_tiles(&none, &requests, None).rects.iter().all(|rect| rect.width == 1));
}

#[test]
fn in_a_map_without_pixels_all_requests_are_rejected() {
    let requests = [request(4, 1, 64.0, 0.0), request(2, 0, 64.0, 0.0), request(1, 6, 64.0, 0.0)];
    let got = allocate_tiles(&AtlasConfig { map_px: 0, ..CONFIG }, &requests, None);
    assert_eq!((got.rejected, got.owners.len()), (vec![1, 4], 0));
}

#[test]
fn a_previous_position_outside_the_map_is_ignored() {
    let config = AtlasConfig { map_px: 8, smallest_px: 1, largest_px: 1, growth: 0 };
    let one = [request(0, 1, 1.0, 0.0)];
    let before = allocate_tiles(&config, &one, None);
    let mut harmed = before.clone();
    harmed.rects[0] = TileRect { x: u32::MAX, y: u32::MAX, ..before.rects[0] };
    assert_eq!(allocate_tiles(&config, &one, Some(&harmed)), before);
}

#[test]
fn no_requests_give_an_empty_allocation() {
    let got = allocate_tiles(&CONFIG, &[], None);
    assert_eq!((got.owners.len(), got.rects.len(), got.rejected.len(), got.repacked), (0, 0, 0, false));
}

proptest! {
    #[test]
    fn no_input_makes_it_panic(
        config in odd_config(),
        requests in odd_requests(),
        later in odd_requests(),
    ) {
        let first = allocate_tiles(&config, &requests, None);
        let second = allocate_tiles(&config, &later, Some(&first));
        for (got, requests) in [(&first, &requests), (&second, &later)] {
            check_apart(&config, got);
            let mut owners: Vec<u32> = requests.iter().filter(|w| w.tiles > 0).map(|w| w.owner).collect();
            owners.sort_unstable();
            owners.dedup();
            let mut answered: Vec<u32> = got.owners.iter().map(|entry| entry.owner).collect();
            answered.extend(&got.rejected);
            answered.sort_unstable();
            prop_assert_eq!(answered, owners);
        }
    }

    #[test]
    fn the_order_of_requests_does_not_matter(
        (config, requests, shuffled) in (odd_config(), odd_requests()).prop_flat_map(|(config, requests)| {
            (Just(config), Just(requests.clone()), Just(requests).prop_shuffle())
        }),
        before in odd_requests(),
    ) {
        let before = allocate_tiles(&config, &before, None);
        for previous in [None, Some(&before)] {
            let (a, b) = (allocate_tiles(&config, &requests, previous), allocate_tiles(&config, &shuffled, previous));
            prop_assert_eq!(a, b, "{:?}", bits(&shuffled));
        }
    }

    #[test]
    fn in_a_crowd_the_order_of_requests_does_not_matter(
        (config, requests, shuffled, before) in with_history(30).prop_flat_map(|(config, requests, before)| {
            (Just(config), Just(requests.clone()), Just(requests).prop_shuffle(), Just(before))
        }),
    ) {
        prop_assert_eq!(allocate_tiles(&config, &requests, Some(&before)), allocate_tiles(&config, &shuffled, Some(&before)));
    }

    #[test]
    fn a_previous_allocation_that_was_modified_makes_no_tiles_overlap(
        requests in any_requests(CONFIG, 20),
        from in any::<prop::sample::Index>(),
        to in any::<prop::sample::Index>(),
        harm in 0..7,
    ) {
        let whole = allocate_tiles(&CONFIG, &requests, None);
        prop_assume!(!whole.rects.is_empty());
        let mut harmed = whole.clone();
        let (from, to) = (from.index(whole.rects.len()), to.index(whole.rects.len()));
        match harm {
            0 => harmed.rects[to] = whole.rects[from],
            1 => harmed.rects[to].x += CONFIG.smallest_px,
            2 => harmed.rects[to].y += 1,
            3 => harmed.rects[to].x = CONFIG.map_px,
            4 => harmed.rects[to].y = 1 << 31,
            5 => harmed.rects.truncate(to),
            _ => harmed.owners[0] = TileAllocation { tile_px: 0, requested_px: 0, ..harmed.owners[0] },
        }
        let got = allocate_tiles(&CONFIG, &requests, Some(&harmed));
        check_apart(&CONFIG, &got);
        prop_assert_eq!(got.rects.len(), whole.rects.len());
    }
}
