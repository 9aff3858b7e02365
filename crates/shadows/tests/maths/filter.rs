//! The filters' weights.

use proptest::prelude::*;
use shadowgraph_shadows::{ShadowFilter, filter_taps};

/// Returns the weights of the texels -3 to 4 along one axis, for a point `fraction` past the centre of texel 0.
fn texel_weights(filter: ShadowFilter, width: f64, fraction: f64) -> [f64; 8] {
    let mut weights = [0.0; 8];
    for (weight, offset) in filter_taps(filter, width, fraction) {
        let first = offset.floor();
        let part = offset - first;
        let index = (first + 3.0) as usize;
        weights[index] += weight * (1.0 - part);
        if part > 0.0 {
            weights[index + 1] += weight * part;
        }
    }
    weights
}

/// Returns the same by numerical integration of a tent.
fn brute_force_weights(half: f64, fraction: f64) -> [f64; 8] {
    const STEPS: i32 = 4000;
    let mut weights = [0.0; 8];
    for (texel, weight) in (-3..).zip(&mut weights) {
        for step in 0..STEPS {
            let at = f64::from(texel) - 0.5 + (f64::from(step) + 0.5) / f64::from(STEPS) - fraction;
            *weight += (1.0 - at.abs() / half).max(0.0) / half / f64::from(STEPS);
        }
    }
    weights
}

#[test]
fn row_21_weights_are_those_of_a_brute_force_tent() {
    for filter in [ShadowFilter::Tent3, ShadowFilter::Tent5, ShadowFilter::Tent7] {
        for (step, width) in (0..=20).flat_map(|step| [1.0, 0.7, 0.3].map(|width| (step, width))) {
            let fraction = f64::from(step) / 20.0;
            let expected = brute_force_weights((filter.half_width_texels() * width).max(0.5), fraction);
            for (ours, expected) in texel_weights(filter, width, fraction).into_iter().zip(expected) {
                assert!((ours - expected).abs() < 1e-6, "{filter:?} {width} {fraction}: {ours} {expected}");
            }
        }
    }
}

#[test]
fn row_21_filters_make_1_4_9_and_16_comparisons() {
    let counts = ShadowFilter::ALL.map(|filter| filter_taps(filter, 1.0, 0.4).count().pow(2));
    assert_eq!(counts, [1, 4, 9, 16]);
    // One comparison is the hardware's bilinear filter over 2 x 2 texels.
    assert_eq!(texel_weights(ShadowFilter::Tent2, 1.0, 0.25)[3..5], [0.75, 0.25]);
}

fn any_filter() -> impl Strategy<Value = ShadowFilter> {
    prop::sample::select(&ShadowFilter::ALL[..])
}

proptest! {
    #[test]
    fn weights_add_up_to_one_for_every_point(filter in any_filter(), x in 0.0..1.0, width in 0.2..=1.0) {
        let sum = texel_weights(filter, width, x).iter().sum::<f64>();
        prop_assert!((sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_tap_reads_its_two_texels(filter in any_filter(), x in 0.0..1.0, width in 0.2..=1.0) {
        for (tap, (weight, offset)) in filter_taps(filter, width, x).enumerate() {
            let first = tap as f64 * 2.0 - f64::from(filter.taps() - 1);
            prop_assert!(weight >= 0.0 && offset >= first && offset <= first + 1.0);
        }
    }
}

#[test]
fn weights_are_continuous_from_texel_to_texel() {
    for filter in ShadowFilter::ALL {
        let (end, start) = (texel_weights(filter, 1.0, 1.0 - 1e-12), texel_weights(filter, 1.0, 0.0));
        assert!((0..7).all(|i| (end[i + 1] - start[i]).abs() < 1e-9), "{end:?} {start:?}");
    }
}

#[test]
fn row_08_filter_stays_in_the_tile_up_to_the_edges_of_its_inner_part() {
    let width = 64.0;
    for filter in ShadowFilter::ALL {
        let (border, last) = (f64::from(filter.kernel_radius_texels()), f64::from(filter.taps()));
        for step in 0..=1000 {
            let at = border + (width - 2.0 * border) * f64::from(step) / 1000.0;
            // Centre of the texel that offsets count from; the filter reads the same number of texels before and after it.
            let base = (at + 0.5).floor() - 0.5;
            let first = base - (last - 1.0);
            assert!(first > 0.0 && base + last < width, "{filter:?} {at}");
            assert!((at - first).max(base + last - at) <= f64::from(filter.kernel_radius_texels()));
        }
    }
}
