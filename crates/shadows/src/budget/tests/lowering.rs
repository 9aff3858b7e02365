//! Random settings, lowered by random levels.

use super::*;

pub(super) fn any_quality() -> impl Strategy<Value = QualityLevel> {
    let scale = proptest::sample::select(vec![1_u32, 2, 4, 8]);
    let distance = prop_oneof![Just(1.0_f32), 0.05_f32..=1.0];
    (scale, 1_u32..=8, distance).prop_map(|(map_scale, cascades, distance_scale)| QualityLevel {
        map_scale,
        cascades,
        distance_scale,
    })
}

/// One end fewer than cascades: fractions of `last`, ascending.
fn ends(count: u32, last: f32) -> impl Strategy<Value = Vec<f32>> {
    let parts = proptest::collection::btree_set(1_u16..1000, count.saturating_sub(1) as usize);
    parts.prop_map(move |parts| parts.into_iter().map(|part| f32::from(part) / 1000.0 * last).collect())
}

fn any_split(count: u32) -> impl Strategy<Value = SplitScheme> {
    prop_oneof![
        Just(SplitScheme::Standard),
        ends(count, 1.0).prop_map(SplitScheme::Ratios),
        (ends(count, 1.0), 0.01_f32..1e4)
            .prop_map(|(ends, last)| SplitScheme::Metres(ends.iter().map(|end| end * last).collect())),
        (1.01_f32..100.0).prop_map(SplitScheme::Factor),
        (0.001_f32..1e5).prop_map(|first_m| SplitScheme::Geometric { first_m }),
        Just(SplitScheme::Logarithmic),
        (0.0_f32..=1.0).prop_map(|lambda| SplitScheme::Practical { lambda }),
    ]
}

pub(super) fn any_settings() -> impl Strategy<Value = ShadowSettings> {
    let size = (8_u32..=13).prop_map(|log| 1 << log);
    let tiles = prop_oneof![Just(None), (6_u32..=10).prop_map(|log| Some(1 << log))];
    let scales = proptest::collection::vec(0.0_f32..16.0, 0..9);
    let split = (0_u32..=8).prop_flat_map(|count| (Just(count), any_split(count)));
    let distance = (-9.9..19.9_f32).prop_map(f32::exp2);
    (size.clone(), size, tiles, scales, split, distance).prop_map(
        |(cascades_px, atlas_px, tiles, scales, (count, split), distance)| {
            let mut settings = ShadowSettings { distance_m: distance, ..ShadowSettings::default() };
            settings.cascades.map_size_px = cascades_px;
            settings.cascades.count = count;
            settings.cascades.split = split;
            settings.cascades.bias_scales = scales;
            settings.atlas.map_size_px = atlas_px;
            let by_importance = |px: u32| AtlasTiles::ByImportance { smallest_px: px.min(atlas_px / 4) };
            settings.atlas.tiles = tiles.map_or(AtlasTiles::Even, by_importance);
            settings
        },
    )
}

pub(super) fn apply(quality: QualityLevel, settings: &ShadowSettings) -> ShadowSettings {
    let config = BudgetConfig { levels: vec![quality], ..BudgetConfig::default() };
    QualityController::new(config).unwrap().apply(settings)
}

fn smallest(settings: &ShadowSettings) -> u32 {
    match settings.atlas.tiles {
        AtlasTiles::Even => settings.atlas.map_size_px / 4,
        AtlasTiles::ByImportance { smallest_px } => smallest_px,
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1024))]

    #[test]
    fn valid_settings_stay_valid(settings in any_settings(), quality in any_quality()) {
        prop_assert_eq!(settings.validate(), Ok(()));
        prop_assert_eq!(apply(quality, &settings).validate(), Ok(()));
    }

    #[test]
    fn no_setting_gets_better_than_chosen(settings in any_settings(), quality in any_quality()) {
        let lowered = apply(quality, &settings);
        prop_assert!(lowered.distance_m <= settings.distance_m);
        prop_assert!(lowered.cascades.count <= settings.cascades.count);
        prop_assert!(lowered.cascades.map_size_px <= settings.cascades.map_size_px);
        prop_assert!(lowered.atlas.map_size_px <= settings.atlas.map_size_px);
        prop_assert!(smallest(&lowered) <= smallest(&settings));
    }

    #[test]
    fn settings_are_lowered_as_the_level_says(settings in any_settings(), quality in any_quality()) {
        let lowered = apply(quality, &settings);
        let px = |size: u32| (size / quality.map_scale).max(256);
        prop_assert_eq!(lowered.cascades.map_size_px, px(settings.cascades.map_size_px));
        prop_assert_eq!(lowered.atlas.map_size_px, px(settings.atlas.map_size_px));
        prop_assert!(lowered.cascades.count <= quality.cascades);
        prop_assert!(lowered.distance_m <= (settings.distance_m * quality.distance_scale).max(0.001));
        // But by no cascade and no metre more than that, unless a cascade has nothing left to cover.
        prop_assert!(lowered.distance_m >= settings.distance_m * quality.distance_scale);
        if !matches!(settings.cascades.split, SplitScheme::Metres(_)) {
            prop_assert_eq!(lowered.cascades.count, settings.cascades.count.min(quality.cascades));
        }
    }

    #[test]
    fn all_other_settings_stay_the_same(settings in any_settings(), quality in any_quality()) {
        let mut lowered = apply(quality, &settings);
        lowered.distance_m = settings.distance_m;
        lowered.atlas.map_size_px = settings.atlas.map_size_px;
        lowered.atlas.tiles = settings.atlas.tiles;
        lowered.cascades.map_size_px = settings.cascades.map_size_px;
        lowered.cascades.count = settings.cascades.count;
        lowered.cascades.split = settings.cascades.split.clone();
        lowered.cascades.bias_scales = settings.cascades.bias_scales.clone();
        prop_assert_eq!(lowered, settings);
    }

    #[test]
    fn the_best_level_changes_nothing(settings in any_settings()) {
        prop_assert_eq!(apply(QualityLevel::default(), &settings), settings);
    }

    #[test]
    fn the_atlas_holds_as_many_smallest_tiles_as_before_if_they_are_not_too_small(
        settings in any_settings(),
        quality in any_quality(),
    ) {
        let lowered = apply(quality, &settings);
        let across = |settings: &ShadowSettings| settings.atlas.map_size_px / smallest(settings);
        prop_assert!(across(&lowered) >= across(&settings) || smallest(&lowered) == 64);
        prop_assert!(across(&lowered) >= 4);
    }
}

#[test]
fn invalid_settings_are_returned_unchanged() {
    let mut settings = ShadowSettings { distance_m: 1e7, ..ShadowSettings::default() };
    let cheap = QualityLevel { map_scale: 8, cascades: 1, distance_scale: 0.05 };
    assert_eq!(apply(cheap, &settings), settings);
    settings = ShadowSettings::default();
    settings.cascades.map_size_px = 300;
    assert_eq!(apply(cheap, &settings), settings);
}
