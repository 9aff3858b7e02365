//! The filter's weights.

use proptest::prelude::*;
use shadowgraph_shadows::{BORDER_PX, FILTER_REACH_TEXELS, FILTER_SUM, filter_taps};

/// The weights of the texels -2 to 3 along one axis.
fn texel_weights(fraction: f64) -> [f64; 6] {
    let mut weights = [0.0; 6];
    for (weight, offset) in filter_taps(fraction) {
        let first = offset.floor();
        let part = offset - first;
        let index = (first + 2.0) as usize;
        weights[index] += weight * (1.0 - part);
        if part > 0.0 {
            weights[index + 1] += weight * part;
        }
    }
    weights
}

proptest! {
    #[test]
    fn weights_add_up_to_one_wherever_the_point_is(x in 0.0..1.0, y in 0.0..1.0) {
        let sum = |fraction: f64| texel_weights(fraction).iter().sum::<f64>();
        prop_assert!((sum(x) * sum(y) / FILTER_SUM - 1.0).abs() < 1e-12);
    }

    #[test]
    fn every_tap_mixes_the_two_texels_it_is_meant_for(x in 0.0..1.0) {
        for (tap, (weight, offset)) in filter_taps(x).into_iter().enumerate() {
            let first = tap as f64 * 2.0 - 2.0;
            prop_assert!(weight > 0.0 && offset >= first && offset <= first + 1.0);
        }
    }

    #[test]
    fn weights_have_their_centre_at_the_point(x in 0.0..1.0) {
        let centre: f64 = texel_weights(x).iter().zip(-2..).map(|(w, texel)| w * f64::from(texel)).sum();
        prop_assert!((centre / 12.0 - x).abs() < 1e-12);
    }
}

#[test]
fn weights_move_on_by_a_texel_without_a_jump() {
    let (end, start) = (texel_weights(1.0 - 1e-12), texel_weights(0.0));
    assert!((0..5).all(|i| (end[i + 1] - start[i]).abs() < 1e-9), "{end:?} {start:?}");
}

#[test]
fn filter_stays_in_the_tile_up_to_the_edges_of_its_inner_part() {
    let width = 64.0;
    let border = f64::from(BORDER_PX);
    for step in 0..=1000 {
        let at = border + (width - 2.0 * border) * f64::from(step) / 1000.0;
        // Centre of the texel that the point is counted from; the filter reads 2 before to 3 after it.
        let base = (at + 0.5).floor() - 0.5;
        assert!(base - 2.0 > 0.0 && base + 3.0 < width, "{at}");
        assert!((at - (base - 2.0)).max(base + 3.0 - at) <= f64::from(FILTER_REACH_TEXELS));
    }
}
