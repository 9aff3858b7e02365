//! Stability of sizes and of rejections from frame to frame.

use super::*;

/// Allocates frame after frame, and returns all allocations, beginning with `start`.
fn run(
    config: &AtlasConfig,
    start: &AtlasAllocation,
    frames: impl Iterator<Item = Vec<TileRequest>>,
) -> Vec<AtlasAllocation> {
    let mut all = vec![start.clone()];
    for requests in frames {
        all.push(allocate_tiles(config, &requests, all.last()));
    }
    all
}

#[test]
fn a_small_light_that_comes_and_goes_makes_another_smaller_only_once() {
    // Three quarters of the map are in use at the requested size; with the last light, all of it.
    let base: Vec<TileRequest> = (0..4).map(|owner| request(owner, 1, 256.0, -f64::from(owner))).collect();
    let with: Vec<TileRequest> = base.iter().copied().chain([request(9, 1, 128.0, 9.0)]).collect();
    let start = allocate_tiles(&CONFIG, &base, None);
    let frames = (0..10).map(|frame| if frame % 2 == 0 { with.clone() } else { base.clone() });
    let all = run(&CONFIG, &start, frames);
    assert_eq!(size_of(&all[0], 3), Some(256));
    assert!(all[1..].iter().all(|got| size_of(got, 3) == Some(128)));
}

#[test]
fn a_halved_size_grows_again_once_a_tenth_of_the_map_stays_free() {
    let base = [request(0, 12, 128.0, 9.0), request(1, 1, 128.0, 0.0), request(2, 20, 32.0, 1.0)];
    let crowd = |more: u32| base.iter().copied().chain([request(3, more, 32.0, 1.0)]).collect::<Vec<_>>();
    // Of 256 cells 12 * 16 + 20 are taken. The last light takes 16 or 4 of the 44 that are left: 29 more are too many.
    let halved = allocate_tiles(&CONFIG, &crowd(29), None);
    assert_eq!(size_of(&halved, 1), Some(64));
    assert_eq!(size_of(&allocate_tiles(&CONFIG, &crowd(28), None), 1), Some(128));
    // 228 + 3 = 231 cells are more than nine tenths of the map, 230 are less.
    assert_eq!(size_of(&allocate_tiles(&CONFIG, &crowd(3), Some(&halved)), 1), Some(64));
    assert_eq!(size_of(&allocate_tiles(&CONFIG, &crowd(2), Some(&halved)), 1), Some(128));
}

#[test]
fn nobody_grows_into_the_space_that_a_rejected_owner_leaves_free() {
    // Owner 0 requests for four cells. Owner 9 is the last and needs 32.
    let lights = |more: u32| {
        let others = (1..8).map(|owner| request(owner, if owner < 7 { 32 } else { more }, 32.0, 1.0));
        others.chain([request(0, 1, 64.0, 2.0), request(9, 32, 32.0, 0.0)]).collect::<Vec<_>>()
    };
    let full = allocate_tiles(&CONFIG, &lights(31), None);
    assert_eq!((full.rects.len(), size_of(&full, 0), full.rejected.len()), (256, Some(32), 0));
    // One cell more, and 31 are free: three more would leave 28 of 256, more than a tenth.
    let crowded = allocate_tiles(&CONFIG, &lights(32), Some(&full));
    assert_eq!((crowded.rects.len(), size_of(&crowded, 0), &crowded.rejected[..]), (225, Some(32), &[9][..]));
    // Without a previous frame it does grow, and stays so.
    let first = allocate_tiles(&CONFIG, &lights(32), None);
    assert_eq!(size_of(&first, 0), Some(64));
    assert_eq!(size_of(&allocate_tiles(&CONFIG, &lights(32), Some(&first)), 0), Some(64));
}

#[test]
fn a_rejected_owner_is_admitted_as_soon_as_it_fits() {
    let mut requests: Vec<TileRequest> =
        (0..43).map(|owner| request(owner, 6, 32.0, -f64::from(owner))).collect();
    let crowded = allocate_tiles(&CONFIG, &requests, None);
    assert_eq!(crowded.rejected, [42]);
    // 252 cells are taken, 4 are left, and 2 become free.
    requests[3].tiles = 4;
    let got = allocate_tiles(&CONFIG, &requests, Some(&crowded));
    assert!(got.rejected.is_empty());
    assert_eq!(got.rects.len(), 256);
}

proptest! {
    #[test]
    fn repeated_requests_change_nothing((config, requests, before) in with_history(30)) {
        let once = allocate_tiles(&config, &requests, Some(&before));
        let again = allocate_tiles(&config, &requests, Some(&once));
        prop_assert_eq!(&again, &AtlasAllocation { repacked: false, ..once });
    }

    #[test]
    fn a_request_that_varies_by_a_tenth_changes_sizes_at_most_once(
        (config, requests, before) in with_history(20),
        who in any::<prop::sample::Index>(),
        swings in prop::collection::vec(prop_oneof![Just(0.9), Just(1.1), 0.9_f64..1.1], 20),
    ) {
        prop_assume!(!requests.is_empty());
        let who = who.index(requests.len());
        let settled = allocate_tiles(&config, &requests, Some(&before));
        let frames = swings.into_iter().map(|swing| {
            let mut requests = requests.clone();
            requests[who].size_px *= swing;
            requests
        });
        let all = run(&config, &settled, frames);
        let changes = all.windows(2).filter(|pair| sizes(&pair[0]) != sizes(&pair[1])).count();
        prop_assert!(changes <= 1, "{changes}");
    }

    #[test]
    fn a_single_request_that_varies_by_a_tenth_changes_its_size_at_most_once(
        first in 10.0_f64..1000.0,
        around in 10.0_f64..1000.0,
        swings in prop::collection::vec(prop_oneof![Just(0.9), Just(1.1), 0.9_f64..1.1], 20),
    ) {
        let start = allocate_tiles(&CONFIG, &[request(0, 1, first, 0.0)], None);
        let all = run(&CONFIG, &start, swings.into_iter().map(|swing| vec![request(0, 1, around * swing, 0.0)]));
        let changes = all.windows(2).filter(|pair| sizes(&pair[0]) != sizes(&pair[1])).count();
        prop_assert!(changes <= 1, "{changes}");
    }

    #[test]
    fn a_light_of_a_tenth_of_the_map_that_comes_and_goes_changes_sizes_at_most_once(
        (config, mut requests, before) in with_history(30),
        size in any_size(),
        importance in any_importance(),
    ) {
        let visitor = request(1000, 1, f64::from(config.smallest_px) * size.exp2(), importance);
        let alone = allocate_tiles(&config, &[visitor], None);
        prop_assume!(10 * u64::from(alone.rects[0].width).pow(2) <= u64::from(config.map_px).pow(2));
        let start = allocate_tiles(&config, &requests, Some(&before));
        let without = requests.clone();
        requests.push(visitor);
        let frames = (0..8).map(|frame| if frame % 2 == 0 { requests.clone() } else { without.clone() });
        let all = run(&config, &start, frames);
        // Owners that are rejected when it comes are admitted again when it goes; they are not compared.
        for entry in all[1].owners.iter().filter(|entry| entry.owner != 1000) {
            prop_assert!(size_of(&all[0], entry.owner).unwrap() >= entry.tile_px);
            for later in &all[2..] {
                prop_assert_eq!(size_of(later, entry.owner), Some(entry.tile_px));
            }
        }
    }
}
