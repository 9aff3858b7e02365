//! Rounding of continuous requests to powers of two.

use super::*;

fn allocated_px(size_px: f64, previous: Option<&AtlasAllocation>) -> (u32, AtlasAllocation) {
    let got = allocate_tiles(&CONFIG, &[request(0, 1, size_px, 0.0)], previous);
    (size_of(&got, 0).unwrap(), got)
}

#[test]
fn a_first_request_is_rounded_to_the_nearest_size_as_a_ratio() {
    for (size_px, expected) in
        [(32.0, 32), (45.2, 32), (45.3, 64), (64.0, 64), (90.5, 64), (90.6, 128), (181.1, 256)]
    {
        assert_eq!(allocated_px(size_px, None).0, expected, "{size_px}");
    }
}

#[test]
fn a_request_out_of_range_is_clamped() {
    for (size_px, expected) in [(-1e300, 32), (0.0, 32), (31.0, 32), (257.0, 256), (1e300, 256)] {
        assert_eq!(allocated_px(size_px, None).0, expected, "{size_px}");
    }
}

#[test]
fn a_size_is_kept_until_the_request_is_a_factor_of_two_away() {
    let (_, before) = allocated_px(100.0, None);
    for (size_px, expected) in
        [(64.1, 128), (90.0, 128), (182.0, 128), (255.9, 128), (256.0, 256), (64.0, 64), (40.0, 32)]
    {
        assert_eq!(allocated_px(size_px, Some(&before)).0, expected, "{size_px}");
    }
}

#[test]
fn a_request_at_an_end_of_the_range_reaches_it_from_the_next_size() {
    let (_, near) = allocated_px(128.0, None);
    assert_eq!(allocated_px(1e6, Some(&near)).0, 256);
    let (_, far) = allocated_px(64.0, None);
    assert_eq!(allocated_px(0.0, Some(&far)).0, 32);
}

#[test]
fn hysteresis_uses_the_requested_size_and_not_the_allocated_size() {
    // All request the largest size, of which the map holds four.
    let five: Vec<TileRequest> = (0..5).map(|owner| request(owner, 1, 256.0, 0.0)).collect();
    let crowded = allocate_tiles(&CONFIG, &five, None);
    assert_eq!(size_of(&crowded, 4), Some(128));
    let alone = allocate_tiles(&CONFIG, &[request(4, 1, 140.0, 0.0)], Some(&crowded));
    assert_eq!(size_of(&alone, 4), Some(256));
}
