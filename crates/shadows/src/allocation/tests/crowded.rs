//! More requests than the map can hold.

use super::*;

fn equal(owners: std::ops::Range<u32>, tiles: u32, size_px: f64) -> Vec<TileRequest> {
    owners.map(|owner| request(owner, tiles, size_px, -f64::from(owner))).collect()
}

#[test]
fn requests_that_fit_get_the_requested_size() {
    let got = allocate_tiles(&CONFIG, &equal(0..4, 1, 256.0), None);
    assert_eq!(sizes(&got), [(0, 256), (1, 256), (2, 256), (3, 256)]);
    assert!(got.rejected.is_empty());
}

#[test]
fn one_request_too_many_halves_the_least_important_first() {
    // Five tiles at half size take 5/16 of the map. Each doubling takes 3/16 more: three fit.
    let got = allocate_tiles(&CONFIG, &equal(0..5, 1, 256.0), None);
    assert_eq!(sizes(&got), [(0, 256), (1, 256), (2, 256), (3, 128), (4, 128)]);
}

#[test]
fn a_size_is_restored_to_nobody_after_the_first_that_it_does_not_fit_for() {
    // The point light takes 6/16 at 128, so 18/16 more to be 256; the spot light after it would have fitted.
    let got = allocate_tiles(&CONFIG, &[request(0, 6, 256.0, 1.0), request(1, 1, 256.0, 0.0)], None);
    assert_eq!(sizes(&got), [(0, 128), (1, 128)]);
    let got = allocate_tiles(&CONFIG, &[request(0, 6, 256.0, 0.0), request(1, 1, 256.0, 1.0)], None);
    assert_eq!(sizes(&got), [(0, 128), (1, 256)]);
}

#[test]
fn requests_grow_together_where_the_map_has_space() {
    let roomy = AtlasConfig { growth: 2, largest_px: 512, ..CONFIG };
    let pair = |importance| [request(0, 1, 64.0, 0.0), request(1, 1, 32.0, importance)];
    // Four times as wide, and no wider.
    assert_eq!(sizes(&allocate_tiles(&roomy, &pair(0.0), None)), [(0, 256), (1, 128)]);
    assert_eq!(sizes(&allocate_tiles(&roomy, &pair(9.0), None)), [(0, 256), (1, 128)]);
    // The least important are the first that get less.
    let five: Vec<_> = (0..5).map(|owner| request(owner, 1, 64.0, -f64::from(owner))).collect();
    let got = allocate_tiles(&roomy, &five, None);
    assert_eq!(sizes(&got), [(0, 256), (1, 256), (2, 256), (3, 128), (4, 128)]);
}

#[test]
fn row_53_thirteen_lights_use_nearly_all_of_the_map() {
    // Ten point lights and three spot lights that request a tenth of what there is.
    let config = AtlasConfig { map_px: 2048, smallest_px: 64, largest_px: 2048, growth: 2 };
    for size_px in [60.0, 80.0, 110.0, 150.0, 200.0, 300.0] {
        let light = |owner: u32| {
            let (tiles, nearer) = if owner < 10 { (6, 1.0) } else { (1, 2.0) };
            request(owner, tiles, size_px * nearer, -f64::from(owner))
        };
        let got = allocate_tiles(&config, &(0..13).map(light).collect::<Vec<_>>(), None);
        let used: u64 = got.rects.iter().map(|rect| u64::from(rect.width).pow(2)).sum();
        assert!(used as f64 > 0.85 * 2048.0 * 2048.0, "{size_px}: {used} {:?}", sizes(&got));
    }
}

#[test]
fn only_the_least_important_are_rejected() {
    let got = allocate_tiles(&CONFIG, &equal(0..50, 6, 256.0), None);
    assert_eq!(got.owners.len(), 42);
    assert_eq!(got.rejected, (42..50).collect::<Vec<_>>());
    assert!(got.owners.iter().all(|entry| entry.tile_px == 32));
}

#[test]
fn nobody_overtakes_a_more_important_owner_that_is_rejected() {
    let mut requests = equal(0..42, 6, 32.0);
    // 252 of 256 cells are taken, so six more do not fit. One more would.
    requests.extend([request(60, 6, 32.0, -100.0), request(61, 1, 32.0, -101.0)]);
    assert_eq!(allocate_tiles(&CONFIG, &requests, None).rejected, [60, 61]);
}

#[test]
fn of_equally_important_owners_the_lower_is_served_first() {
    let requests: Vec<TileRequest> = [9, 2, 5, 7, 3].map(|owner| request(owner, 1, 256.0, 1.0)).to_vec();
    let got = allocate_tiles(&CONFIG, &requests, None);
    assert_eq!(sizes(&got), [(2, 256), (3, 256), (5, 256), (7, 128), (9, 128)]);
}

#[test]
fn a_map_of_4096_holds_64_point_and_64_spot_lights() {
    let config = AtlasConfig { map_px: 4096, smallest_px: 32, largest_px: 1024, growth: 0 };
    let light = |owner: u32| request(owner, if owner < 64 { 6 } else { 1 }, 1024.0, f64::from(owner % 64));
    let requests: Vec<TileRequest> = (0..128).map(light).collect();
    let got = allocate_tiles(&config, &requests, None);
    assert_eq!((got.owners.len(), got.rejected.len(), got.rects.len()), (128, 0, 448));
    reference::check(&config, &requests, None, &got);
    // 448 tiles of 128 px take 0.4375 of the map. Only a part of them can be 256 px.
    assert!(got.owners.iter().all(|entry| entry.tile_px == 128 || entry.tile_px == 256));
}

proptest! {
    /// The rule of the documentation: the fewest common halvings that fit, and one less for each owner from the first on.
    #[test]
    fn without_history_sizes_halve_together_and_the_first_are_halved_once_less((config, requests) in config_and_requests(40)) {
        let got = allocate_tiles(&config, &requests, None);
        let mut ranked: Vec<&TileRequest> = requests.iter().filter(|request| got.for_owner(request.owner).is_some()).collect();
        ranked.sort_by(|a, b| b.importance.total_cmp(&a.importance).then(a.owner.cmp(&b.owner)));
        let entries: Vec<TileAllocation> = ranked.iter().map(|request| *got.for_owner(request.owner).unwrap()).collect();
        let size = |one: &TileAllocation, halvings: u32| {
            ((one.requested_px << config.growth) >> halvings).clamp(config.smallest_px, config.largest_px)
        };
        let area = |one: &TileAllocation, halvings: u32| u64::from(size(one, halvings)).pow(2) * one.tiles as u64;
        let capacity = u64::from(config.map_px).pow(2);
        let total = |k: u32| entries.iter().map(|one| area(one, k)).sum::<u64>();
        let k = (0..12).find(|&k| total(k) <= capacity).unwrap();
        let mut left = capacity - total(k);
        let mut restored = k > 0;
        for one in &entries {
            let more = if restored { area(one, k - 1) - area(one, k) } else { 0 };
            restored &= more <= left;
            left -= if restored { more } else { 0 };
            prop_assert_eq!(one.tile_px, size(one, if restored { k - 1 } else { k }));
        }
    }
}
