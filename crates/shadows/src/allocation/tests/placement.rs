//! Positions of tiles from frame to frame.

use super::*;

const SMALL: AtlasConfig = AtlasConfig { map_px: 128, smallest_px: 32, largest_px: 128, growth: 0 };

fn origin_of(allocation: &AtlasAllocation, owner: u32) -> [u32; 2] {
    let rects = allocation.rects_for(owner);
    assert_eq!(rects.len(), 1);
    [rects[0].x, rects[0].y]
}

#[test]
fn first_tiles_are_placed_largest_first_in_morton_order() {
    let requests = [
        request(0, 1, 32.0, 0.0),
        request(1, 1, 64.0, 0.0),
        request(2, 1, 32.0, 0.0),
        request(3, 1, 64.0, 0.0),
    ];
    let got = allocate_tiles(&SMALL, &requests, None);
    assert_eq!([1, 3, 0, 2].map(|owner| origin_of(&got, owner)), [[0, 0], [64, 0], [0, 64], [32, 64]]);
}

#[test]
fn a_new_tile_is_placed_in_the_smallest_free_block_that_holds_it() {
    let five: Vec<TileRequest> = (0..5).map(|owner| request(owner, 1, 32.0, 0.0)).collect();
    let before = allocate_tiles(&SMALL, &five, None);
    assert_eq!(origin_of(&before, 4), [64, 0]);
    // Without the first quarter's owners that quarter is free, but the second one is in use already.
    let got = allocate_tiles(&SMALL, &[five[4], request(9, 1, 32.0, 0.0)], Some(&before));
    assert_eq!(origin_of(&got, 9), [96, 0]);
    let got = allocate_tiles(&SMALL, &[five[4], request(9, 1, 64.0, 0.0)], Some(&before));
    assert_eq!(origin_of(&got, 9), [0, 0]);
}

#[test]
fn a_new_owner_takes_the_position_of_one_that_was_removed() {
    let full: Vec<TileRequest> = (0..16).map(|owner| request(owner, 1, 32.0, 0.0)).collect();
    let before = allocate_tiles(&SMALL, &full, None);
    let mut changed = full.clone();
    changed[6].owner = 99;
    let got = allocate_tiles(&SMALL, &changed, Some(&before));
    assert_eq!(origin_of(&got, 99), origin_of(&before, 6));
    assert!(
        full.iter()
            .filter(|request| request.owner != 6)
            .all(|w| origin_of(&got, w.owner) == origin_of(&before, w.owner))
    );
    assert!(!got.repacked);
}

#[test]
fn the_map_is_repacked_only_when_the_free_space_is_fragmented() {
    let full: Vec<TileRequest> = (0..16).map(|owner| request(owner, 1, 32.0, 0.0)).collect();
    let before = allocate_tiles(&SMALL, &full, None);
    // Three of each quarter stay: four cells are free, but no square of four.
    let mut requests: Vec<TileRequest> =
        full.iter().copied().filter(|request| request.owner % 4 != 3).collect();
    let loose = allocate_tiles(&SMALL, &requests, Some(&before));
    assert!(!loose.repacked);
    requests.push(request(99, 1, 64.0, 0.0));
    let got = allocate_tiles(&SMALL, &requests, Some(&loose));
    assert!(got.repacked);
    assert_eq!(origin_of(&got, 99), [0, 0]);
    assert_eq!(got.rects.len(), 13);
    assert!(!allocate_tiles(&SMALL, &requests, Some(&got)).repacked);
}

#[test]
fn an_owner_with_more_or_fewer_tiles_of_the_same_size_keeps_the_common_ones() {
    let before = allocate_tiles(&SMALL, &[request(0, 2, 32.0, 0.0), request(1, 1, 32.0, 0.0)], None);
    let more = allocate_tiles(&SMALL, &[request(0, 4, 32.0, 0.0), request(1, 1, 32.0, 0.0)], Some(&before));
    assert_eq!(more.rects_for(0)[..2], *before.rects_for(0));
    assert_eq!(more.rects_for(1), before.rects_for(1));
    let fewer = allocate_tiles(&SMALL, &[request(0, 1, 32.0, 0.0), request(1, 1, 32.0, 0.0)], Some(&more));
    assert_eq!(fewer.rects_for(0), &before.rects_for(0)[..1]);
}

#[test]
fn a_previous_allocation_with_another_config_is_ignored() {
    let requests: Vec<TileRequest> = (3..6).map(|owner| request(owner, 2, 60.0, 0.0)).collect();
    for other in [
        AtlasConfig { map_px: 256, ..SMALL },
        AtlasConfig { smallest_px: 16, ..SMALL },
        AtlasConfig { largest_px: 64, ..SMALL },
    ] {
        let mut first = requests.clone();
        first.extend([request(0, 1, 64.0, 0.0), request(4, 1, 120.0, 5.0)]);
        let before = allocate_tiles(&other, &first, None);
        assert_ne!(before.rects_for(3), allocate_tiles(&SMALL, &requests, None).rects_for(3));
        assert_eq!(allocate_tiles(&SMALL, &requests, Some(&before)), allocate_tiles(&SMALL, &requests, None));
    }
    assert_eq!(
        allocate_tiles(&SMALL, &requests, Some(&AtlasAllocation::default())),
        allocate_tiles(&SMALL, &requests, None)
    );
}
