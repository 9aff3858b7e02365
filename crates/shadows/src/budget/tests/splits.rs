//! The cascades that remain of a user's list.

use super::lowering::{any_quality, any_settings, apply};
use super::*;

fn listed(split: &SplitScheme) -> Option<&[f32]> {
    match split {
        SplitScheme::Ratios(ends) | SplitScheme::Metres(ends) => Some(ends),
        _ => None,
    }
}

/// Returns settings with 150 m of shadows.
fn settings_with(split: SplitScheme, bias_scales: &[f32]) -> ShadowSettings {
    let mut settings = ShadowSettings::default();
    settings.cascades.count = listed(&split).map_or(4, |ends| ends.len() as u32 + 1);
    settings.cascades.split = split;
    settings.cascades.bias_scales = bias_scales.to_vec();
    settings
}

/// Returns the remaining ends.
fn left(settings: &ShadowSettings, cascades: u32, distance_scale: f32) -> Vec<f32> {
    let lowered =
        apply(QualityLevel { cascades, distance_scale, ..QualityLevel::default() }, settings).cascades;
    let ends = listed(&lowered.split).unwrap().to_vec();
    assert_eq!(ends.len() as u32 + 1, lowered.count);
    ends
}

/// Returns the largest growth of texels, compared with the full list of ends.
fn worst_growth(all: &[f32], kept: &[f32], last: f32) -> f32 {
    let covers = |end: &f32| kept.iter().find(|kept| *kept >= end).unwrap_or(&last) / end;
    all.iter().map(covers).fold(1.0, f32::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn remaining_ends_are_the_users(settings in any_settings(), quality in any_quality()) {
        let lowered = apply(quality, &settings).cascades;
        let (before, after) = (listed(&settings.cascades.split), listed(&lowered.split));
        prop_assert_eq!(before.is_some(), after.is_some());
        let before = before.unwrap_or(&[]);
        prop_assert!(after.unwrap_or(&[]).iter().all(|end| before.contains(end)));
    }

    #[test]
    fn no_cascade_begins_beyond_a_shortened_distance(settings in any_settings(), quality in any_quality()) {
        let lowered = apply(quality, &settings);
        if let SplitScheme::Metres(ends) = &lowered.cascades.split
            && lowered.distance_m < settings.distance_m
        {
            prop_assert!(ends.iter().all(|end| *end < lowered.distance_m));
            // Ends within it are removed only if there are too many.
            let within = listed(&settings.cascades.split).unwrap().iter();
            let within = within.filter(|end| **end < lowered.distance_m).count() as u32 + 1;
            prop_assert_eq!(lowered.cascades.count, settings.cascades.count.min(within.min(quality.cascades)));
        }
    }

    #[test]
    fn removing_one_end_loses_as_little_as_possible(settings in any_settings()) {
        let SplitScheme::Ratios(all) = &settings.cascades.split else { return Ok(()) };
        prop_assume!(settings.cascades.count >= 2);
        let kept = left(&settings, settings.cascades.count - 1, 1.0);
        for other in 0..all.len() {
            let mut others = all.clone();
            others.remove(other);
            prop_assert!(worst_growth(all, &kept, 1.0) <= worst_growth(all, &others, 1.0));
        }
    }

    #[test]
    fn a_cascade_keeps_its_bias_when_another_is_removed(settings in any_settings(), quality in any_quality()) {
        let before = &settings.cascades;
        let after = apply(quality, &settings).cascades;
        let (Some(all), Some(kept)) = (listed(&before.split), listed(&after.split)) else { return Ok(()) };
        let scale = |scales: &[f32], i: usize| scales.get(i).copied().unwrap_or(1.0);
        for (i, end) in kept.iter().enumerate() {
            let was = all.iter().position(|other| other == end).unwrap();
            prop_assert_eq!(scale(&after.bias_scales, i), scale(&before.bias_scales, was));
        }
    }
}

#[test]
fn the_end_whose_texels_grow_least_is_removed_first() {
    let four = settings_with(SplitScheme::Ratios(vec![0.067, 0.2, 0.467]), &[]);
    assert_eq!(left(&four, 3, 1.0), [0.067, 0.2]);
    assert_eq!(left(&four, 2, 1.0), [0.2]);
    assert_eq!(left(&four, 1, 1.0), [0.0; 0]);
}

#[test]
fn the_last_cascade_grows_too() {
    // By 1.5, 1.3 and 5 times.
    let metres = settings_with(SplitScheme::Metres(vec![15.0, 23.0, 30.0]), &[]);
    assert_eq!(left(&metres, 3, 1.0), [15.0, 30.0]);
}

#[test]
fn of_equals_the_farthest_is_removed() {
    let mut engel = settings_with(SplitScheme::Metres(vec![10.0, 30.0, 90.0]), &[]);
    engel.distance_m = 270.0;
    assert_eq!(left(&engel, 3, 1.0), [10.0, 30.0]);
}

#[test]
fn a_shorter_distance_keeps_metres_and_scales_ratios() {
    let metres = settings_with(SplitScheme::Metres(vec![10.0, 30.0, 90.0]), &[]);
    assert_eq!(left(&metres, 8, 0.7), [10.0, 30.0, 90.0]);
    assert_eq!(left(&metres, 8, 0.5), [10.0, 30.0]);
    assert_eq!(left(&metres, 8, 0.05), [0.0; 0]);
    let at_the_end = settings_with(SplitScheme::Metres(vec![10.0, 75.0]), &[]);
    assert_eq!(left(&at_the_end, 8, 0.5), [10.0]);
    let ratios = settings_with(SplitScheme::Ratios(vec![0.1, 0.4]), &[]);
    assert_eq!(left(&ratios, 8, 0.05), [0.1, 0.4]);
}

#[test]
fn the_last_cascade_within_the_distance_keeps_its_bias() {
    let metres = settings_with(SplitScheme::Metres(vec![10.0, 30.0, 90.0]), &[1.0, 2.0, 3.0, 4.0]);
    let lowered = apply(QualityLevel { distance_scale: 0.5, ..QualityLevel::default() }, &metres).cascades;
    assert_eq!(lowered.bias_scales, [1.0, 2.0, 3.0]);
    // With fewer cascades than that, the one that is merged takes the bias of the farther one.
    let lowered =
        apply(QualityLevel { cascades: 2, distance_scale: 0.5, ..QualityLevel::default() }, &metres).cascades;
    assert_eq!((listed(&lowered.split), lowered.bias_scales), (Some(&[10.0][..]), vec![1.0, 3.0]));
}
