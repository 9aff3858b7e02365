//! Where tiles lie, from frame to frame.

use super::*;

const SMALL: AllotRules = AllotRules { map_px: 128, smallest_px: 32, largest_px: 128 };

fn at(allotment: &Allotment, owner: u32) -> [u32; 2] {
    let rects = allotment.rects_of(owner);
    assert_eq!(rects.len(), 1);
    [rects[0].x, rects[0].y]
}

#[test]
fn the_first_tiles_lie_biggest_first_in_morton_order() {
    let wishes = [wish(0, 1, 32.0, 0.0), wish(1, 1, 64.0, 0.0), wish(2, 1, 32.0, 0.0), wish(3, 1, 64.0, 0.0)];
    let got = allot(&SMALL, &wishes, None);
    assert_eq!([1, 3, 0, 2].map(|owner| at(&got, owner)), [[0, 0], [64, 0], [0, 64], [32, 64]]);
}

#[test]
fn a_new_tile_lies_in_the_smallest_free_block_that_holds_it() {
    let five: Vec<TileWish> = (0..5).map(|owner| wish(owner, 1, 32.0, 0.0)).collect();
    let before = allot(&SMALL, &five, None);
    assert_eq!(at(&before, 4), [64, 0]);
    // Without the first quarter's owners that quarter is free, but the second one is in use already.
    let got = allot(&SMALL, &[five[4], wish(9, 1, 32.0, 0.0)], Some(&before));
    assert_eq!(at(&got, 9), [96, 0]);
    let got = allot(&SMALL, &[five[4], wish(9, 1, 64.0, 0.0)], Some(&before));
    assert_eq!(at(&got, 9), [0, 0]);
}

#[test]
fn an_owner_that_vanished_leaves_its_place_to_a_new_one() {
    let full: Vec<TileWish> = (0..16).map(|owner| wish(owner, 1, 32.0, 0.0)).collect();
    let before = allot(&SMALL, &full, None);
    let mut changed = full.clone();
    changed[6].owner = 99;
    let got = allot(&SMALL, &changed, Some(&before));
    assert_eq!(at(&got, 99), at(&before, 6));
    assert!(full.iter().filter(|wish| wish.owner != 6).all(|w| at(&got, w.owner) == at(&before, w.owner)));
    assert!(!got.repacked);
}

#[test]
fn all_is_placed_anew_only_when_what_is_free_is_in_pieces() {
    let full: Vec<TileWish> = (0..16).map(|owner| wish(owner, 1, 32.0, 0.0)).collect();
    let before = allot(&SMALL, &full, None);
    // Three of each quarter stay: four cells are free, but nowhere a square of four.
    let mut wishes: Vec<TileWish> = full.iter().copied().filter(|wish| wish.owner % 4 != 3).collect();
    let loose = allot(&SMALL, &wishes, Some(&before));
    assert!(!loose.repacked);
    wishes.push(wish(99, 1, 64.0, 0.0));
    let got = allot(&SMALL, &wishes, Some(&loose));
    assert!(got.repacked);
    assert_eq!(at(&got, 99), [0, 0]);
    assert_eq!(got.rects.len(), 13);
    assert!(!allot(&SMALL, &wishes, Some(&got)).repacked);
}

#[test]
fn an_owner_with_more_or_fewer_tiles_of_the_same_size_keeps_those_it_can() {
    let before = allot(&SMALL, &[wish(0, 2, 32.0, 0.0), wish(1, 1, 32.0, 0.0)], None);
    let more = allot(&SMALL, &[wish(0, 4, 32.0, 0.0), wish(1, 1, 32.0, 0.0)], Some(&before));
    assert_eq!(more.rects_of(0)[..2], *before.rects_of(0));
    assert_eq!(more.rects_of(1), before.rects_of(1));
    let fewer = allot(&SMALL, &[wish(0, 1, 32.0, 0.0), wish(1, 1, 32.0, 0.0)], Some(&more));
    assert_eq!(fewer.rects_of(0), &before.rects_of(0)[..1]);
}

#[test]
fn memory_of_other_rules_is_ignored() {
    let wishes: Vec<TileWish> = (3..6).map(|owner| wish(owner, 2, 60.0, 0.0)).collect();
    for other in [
        AllotRules { map_px: 256, ..SMALL },
        AllotRules { smallest_px: 16, ..SMALL },
        AllotRules { largest_px: 64, ..SMALL },
    ] {
        let mut first = wishes.clone();
        first.extend([wish(0, 1, 64.0, 0.0), wish(4, 1, 120.0, 5.0)]);
        let before = allot(&other, &first, None);
        assert_ne!(before.rects_of(3), allot(&SMALL, &wishes, None).rects_of(3));
        assert_eq!(allot(&SMALL, &wishes, Some(&before)), allot(&SMALL, &wishes, None));
    }
    assert_eq!(allot(&SMALL, &wishes, Some(&Allotment::default())), allot(&SMALL, &wishes, None));
}
