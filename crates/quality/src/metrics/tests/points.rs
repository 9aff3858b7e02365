//! Metrics at world points, and percentiles.

use crate::metrics::*;

#[test]
fn a_percentile_is_the_value_at_the_nearest_rank() {
    let values: Vec<f32> = (1..=100).rev().map(|i| i as f32).collect();
    for (percent, expected) in
        [(0.0, 1.0), (1.0, 1.0), (7.0, 7.0), (50.0, 50.0), (98.2, 99.0), (100.0, 100.0)]
    {
        assert_eq!(percentile(&values, percent), Some(expected), "{percent}");
    }
    assert_eq!(percentile(&[3.0, 1.0, 2.0], 99.0), Some(3.0));
    assert_eq!(percentile(&[], 99.0), None);
    assert_eq!(Summary::new(&[]), Summary::default());
}

#[test]
fn still_shadows_do_not_flicker() {
    let frame = vec![0.0, 0.3, 1.0];
    let still = flicker(&[frame.clone(), frame.clone(), frame.clone()], &vec![vec![1.0; 3]; 3]).unwrap();
    assert_eq!(still, Summary { count: 6, mean: 0.0, p99: 0.0 });
}

#[test]
fn flicker_is_the_mean_change_from_frame_to_frame() {
    // 100 points: one blinks, two change by 0.25 once.
    let mut frames = vec![vec![1.0; 100]; 3];
    let truths = frames.clone();
    frames[1][0] = 0.0;
    frames[2][1] = 0.75;
    frames[2][2] = 0.75;
    let samples = flicker(&frames, &truths).unwrap();
    assert_eq!((samples.count, samples.mean, samples.p99), (200, 2.5 / 200.0, 0.25));
}

#[test]
fn points_whose_truth_changes_do_not_count_in_that_pair_of_frames() {
    let frames = [vec![1.0, 1.0], vec![0.0, 1.0], vec![0.0, 0.5]];
    let truths = [vec![1.0, 1.0], vec![0.0, 1.0], vec![0.0, 1.0]];
    // The first point follows its truth; of the pairs left, one of three changes by a half.
    assert_eq!(flicker(&frames, &truths), Ok(Summary { count: 3, mean: 0.5 / 3.0, p99: 0.5 }));
}

#[test]
fn flicker_of_fewer_than_two_frames_is_zero() {
    assert_eq!(flicker(&[], &[]), Ok(Summary::default()));
    assert_eq!(flicker(&[vec![1.0]], &[vec![1.0]]), Ok(Summary::default()));
}

#[test]
fn a_seam_is_how_far_two_cascades_disagree_at_the_same_points() {
    assert_eq!(seam(&[0.2, 1.0], &[0.2, 1.0]), Ok(Summary { count: 2, mean: 0.0, p99: 0.0 }));
    let seam = seam(&[0.0, 1.0, 0.5, 0.5], &[1.0, 0.5, 0.5, 0.5]).unwrap();
    assert_eq!(seam, Summary { count: 4, mean: 0.375, p99: 1.0 });
}

#[test]
fn lists_of_different_lengths_and_numbers_out_of_range_are_errors() {
    let short = flicker(&[vec![1.0; 2], vec![1.0]], &[vec![1.0; 2], vec![1.0; 2]]);
    assert_eq!(short, Err(MetricsError::Length { list: "frames", has: 1, needs: 2 }));
    let missing = flicker(&[vec![1.0]], &[]);
    assert_eq!(missing, Err(MetricsError::Length { list: "truths", has: 0, needs: 1 }));
    assert_eq!(seam(&[1.0], &[]), Err(MetricsError::Length { list: "farther", has: 0, needs: 1 }));
    let nan = seam(&[1.0, f32::NAN], &[1.0, 1.0]);
    assert_eq!(nan, Err(MetricsError::Value { list: "nearer", index: 1, allowed: "0 to 1" }));
    assert_eq!(nan.unwrap_err().to_string(), "invalid value at index 1 of `nearer`; allowed: 0 to 1");
}
