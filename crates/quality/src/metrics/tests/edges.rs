//! Soft edges with widths that are known.

use super::test_image::{TestImage, above, grazing};
use crate::metrics::EdgeError;

/// A ramp from 0 to 1 around an edge at x = 32 + `slant` * y, `width_px` wide across along a row.
fn ramp(x: usize, y: usize, slant: f32, width_px: f32) -> f32 {
    let offset = x as f32 + 0.5 - 32.0 - slant * y as f32;
    (0.5 + offset / width_px).clamp(0.0, 1.0)
}

fn ramps(slant: f32, true_px: f32, measured_px: f32) -> TestImage {
    let mut image = TestImage::new([80, 32], &above(), 1e3, false);
    image.soft_truth = Some(image.by_pixel(|x, y| ramp(x, y, slant, true_px)));
    image.truth = image.by_pixel(|x, y| ramp(x, y, slant, true_px).round());
    image.visibility = image.by_pixel(|x, y| ramp(x, y, slant, measured_px));
    image
}

#[test]
fn an_edge_blurred_to_twice_its_width_has_edge_error_and_nothing_else() {
    let all = ramps(0.0, 8.0, 16.0).all();
    let edges = all.edges.unwrap();
    // In 8 pixels at u = 0.5 to 3.5 from the middle, u/8 and u/16 differ by u/16; the mean of u² is 5.25.
    assert_eq!((edges.penumbra, edges.crossings, edges.unmeasured), (8 * 32, 32, 0));
    assert!((edges.rmse - 5.25_f64.sqrt() / 16.0).abs() < 1e-6, "{edges:?}");
    assert!((edges.width_ratio.unwrap() - 2.0).abs() < 1e-4, "{edges:?}");
    assert_eq!(
        (all.misclassified.total.misclassified, all.missing_contacts.missing, all.peter_panning.missing),
        (0, 0, 0)
    );
}

#[test]
fn widths_do_not_depend_on_the_slant_or_on_where_the_edge_is() {
    // The ends of a ramp fall between pixels, so a narrow one is measured a little too wide.
    for slant in [-0.7, 0.3, 0.9] {
        let mut image = ramps(slant, 8.0, 4.0);
        let ratio = image.all().edges.unwrap().width_ratio.unwrap();
        assert!((ratio - 0.5).abs() < 0.02, "{slant}: {ratio}");
        let moved = image.by_pixel(|x, y| ramp(x + 3, y, slant, 4.0));
        image.visibility = moved;
        let ratio = image.all().edges.unwrap().width_ratio.unwrap();
        assert!((ratio - 0.5).abs() < 0.02, "{slant}, moved: {ratio}");
    }
}

#[test]
fn a_hard_edge_against_a_soft_one_is_eight_tenths_of_a_pixel_wide() {
    let edges = ramps(0.0, 8.0, 1e-3).all().edges.unwrap();
    assert!((edges.width_ratio.unwrap() - 0.8 / 6.4).abs() < 1e-4, "{edges:?}");
}

#[test]
fn an_edge_that_is_not_there_is_unmeasured() {
    let mut image = ramps(0.0, 8.0, 8.0);
    image.visibility.fill(1.0);
    let edges = image.all().edges.unwrap();
    assert_eq!((edges.crossings, edges.unmeasured, edges.width_ratio), (0, 32, None));
}

#[test]
fn falling_edges_and_columns_are_measured_too() {
    let mut image = TestImage::new([48, 64], &grazing(), 1e3, false);
    // A dark stripe along the row from 20 to 44: one edge falls, one rises, down each column.
    let stripe = |y: usize, width: f32| ramp(y + 12, 0, 0.0, width).min(ramp(76 - y - 1, 0, 0.0, width));
    image.soft_truth = Some(image.by_pixel(|_, y| 1.0 - stripe(y, 6.0)));
    image.visibility = image.by_pixel(|_, y| 1.0 - stripe(y, 9.0));
    let edges = image.all().edges.unwrap();
    assert_eq!((edges.crossings, edges.unmeasured), (2 * 48, 0));
    assert!((edges.width_ratio.unwrap() - 1.5).abs() < 1e-3, "{edges:?}");
}

#[test]
fn without_soft_truth_there_is_no_edge_error() {
    assert_eq!(TestImage::new([8, 8], &above(), 1e3, false).all().edges, None);
}

/// Edge errors where the truth is a ramp of 8 pixels at 32 and visibility is what is given for each column.
fn against(visibility: impl Fn(usize) -> f32) -> EdgeError {
    let mut image = ramps(0.0, 8.0, 8.0);
    image.visibility = image.by_pixel(|x, _| visibility(x));
    image.all().edges.unwrap()
}

#[test]
fn the_nearest_measured_edge_in_the_same_direction_counts() {
    let edge = |x: usize, at: f32, width: f32| (0.5 + (x as f32 + 0.5 - at) / width).clamp(0.0, 1.0);
    let near = |x| edge(x, 35.0, 4.0);
    // A wide edge of the same direction behind and ahead, then a falling one that is nearer.
    let behind = |x| if x < 30 { edge(x, 14.0, 12.0).min(1.0 - edge(x, 24.0, 2.0)) } else { near(x) };
    let ahead = |x| if x < 46 { near(x) } else { edge(x, 62.0, 12.0).max(1.0 - edge(x, 48.0, 2.0)) };
    let falling = |x| if x < 31 { 1.0 } else { near(x) };
    for edges in [against(near), against(behind), against(ahead), against(falling)] {
        assert_eq!((edges.crossings, edges.unmeasured), (32, 0));
        assert!((edges.width_ratio.unwrap() - 0.5).abs() < 0.05, "{edges:?}");
    }
}

#[test]
fn a_transition_that_falls_back_below_a_quarter_has_no_width() {
    let edges = against(|x| if (32..35).contains(&x) { 0.6 } else { step(x) });
    assert_eq!((edges.crossings, edges.unmeasured), (0, 32));
    // Falling back to 0.3 is noise.
    let edges = against(|x| [0.0_f32, 0.6, 0.3, 0.6][(x.max(31) - 31).min(3)].max(step(x)));
    assert_eq!((edges.crossings, edges.unmeasured), (32, 0));
}

/// Lit from column 40 on.
fn step(x: usize) -> f32 {
    f32::from(u8::from(x >= 40))
}

#[test]
fn a_penumbra_across_a_silhouette_has_no_width() {
    let mut image = ramps(0.0, 8.0, 8.0);
    for at in (0..80 * 32).filter(|at| at % 80 >= 34) {
        image.positions[at].y = 1.0;
    }
    let edges = image.all().edges.unwrap();
    assert_eq!((edges.crossings, edges.unmeasured, edges.penumbra), (0, 0, 8 * 32));
}
