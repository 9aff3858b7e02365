//! Settings: ranges, files, messages.

use proptest::prelude::*;
use shadowgraph_shadows::{BiasSettings, CascadeSettings, ShadowSettings, SplitScheme};

fn read(text: &str) -> Result<ShadowSettings, String> {
    let settings: ShadowSettings = ron::from_str(text).map_err(|error| error.to_string())?;
    settings.validate().map_err(|error| error.to_string())?;
    Ok(settings)
}

#[test]
fn defaults_are_valid_and_survive_a_round_trip() {
    let settings = ShadowSettings::default();
    let text = ron::to_string(&settings).unwrap();
    assert_eq!(read(&text).unwrap(), settings);
    assert_eq!(read("()").unwrap(), settings);
}

#[test]
fn a_file_changes_only_what_it_names() {
    let text = "(cascades: (count: 3, split: Ratios([0.1, 0.5])), bias: (depth_texels: 1.5))";
    let expected = ShadowSettings {
        cascades: CascadeSettings {
            count: 3,
            split: SplitScheme::Ratios(vec![0.1, 0.5]),
            ..CascadeSettings::default()
        },
        bias: BiasSettings { depth_texels: 1.5, ..BiasSettings::default() },
        ..ShadowSettings::default()
    };
    assert_eq!(read(text).unwrap(), expected);
    read("(cascades: (split: Practical(lambda: 0.5)))").unwrap();
}

#[test]
fn an_unknown_field_is_named_with_the_known_ones() {
    let error = read("(distance: 3.0)").unwrap_err();
    assert!(error.contains("distance") && error.contains("distance_m") && error.contains('1'), "{error}");
    let error = read("(cascades: (\n  number: 3,\n))").unwrap_err();
    assert!(error.contains("number") && error.contains("count") && error.starts_with("2:"), "{error}");
}

#[test]
fn a_value_out_of_range_is_named_with_field_and_range() {
    for (text, expected) in [
        ("(distance_m: -1.0)", "shadow setting `distance_m` is -1; allowed: 0.001 to 1000000 (metres)"),
        ("(distance_m: NaN)", "shadow setting `distance_m` is NaN; allowed: 0.001 to 1000000 (metres)"),
        (
            "(fade_fraction: 1.5)",
            "shadow setting `fade_fraction` is 1.5; allowed: 0.001 to 1 (part of the distance)",
        ),
        ("(cascades: (count: 0))", "shadow setting `cascades.count` is 0; allowed: 1 to 4"),
        ("(cascades: (count: 5))", "shadow setting `cascades.count` is 5; allowed: 1 to 4"),
        (
            "(cascades: (map_size_px: 1000))",
            "shadow setting `cascades.map_size_px` is 1000; allowed: 256, 512, 1024, 2048, 4096 or 8192 (pixels)",
        ),
        (
            "(atlas: (map_size_px: 16384))",
            "shadow setting `atlas.map_size_px` is 16384; allowed: 256, 512, 1024, 2048, 4096 or 8192 (pixels)",
        ),
        (
            "(atlas: (spot_near_m: 0.0))",
            "shadow setting `atlas.spot_near_m` is 0; allowed: 0.0001 to 100 (metres)",
        ),
        (
            "(cascades: (split: Ratios([0.2, 0.1, 0.5])))",
            "shadow setting `cascades.split` is [0.2, 0.1, 0.5] for 4 cascades; \
             allowed: one ratio fewer than cascades, above 0, rising, below 1",
        ),
        (
            "(cascades: (split: Practical(lambda: 2.0)))",
            "shadow setting `cascades.split.lambda` is 2; allowed: 0 to 1 (0: equal lengths)",
        ),
        (
            "(bias: (normal_texels: 9.0))",
            "shadow setting `bias.normal_texels` is 9; allowed: 0 to 4 (texels)",
        ),
        (
            "(bias: (slope: inf))",
            "shadow setting `bias.slope` is inf; allowed: 0 to 4 (times the receiver's slope)",
        ),
        (
            "(bias: (min_slope: -0.1))",
            "shadow setting `bias.min_slope` is -0.1; allowed: 0 to 4 (texels of depth per texel)",
        ),
        (
            "(bias: (max_slope: 0.5))",
            "shadow setting `bias.max_slope` is 0.5; allowed: 1 to 100 (texels of depth per texel)",
        ),
        (
            "(bias: (depth_texels: 17.0))",
            "shadow setting `bias.depth_texels` is 17; allowed: 0 to 16 (texels)",
        ),
    ] {
        assert_eq!(read(text).unwrap_err(), expected, "{text}");
    }
}

#[test]
fn ratios_must_fit_the_number_of_cascades() {
    assert!(read("(cascades: (count: 1, split: Ratios([])))").is_ok());
    for text in ["Ratios([])", "Ratios([0.1, 0.2])", "Ratios([0.1, 0.2, 1.0])", "Ratios([0.0, 0.2, 0.3])"] {
        assert!(read(&format!("(cascades: (split: {text}))")).is_err(), "{text}");
    }
}

proptest! {
    #[test]
    fn valid_settings_survive_a_round_trip(
        distance_m in 0.001f32..1e6, lambda in 0f32..=1.0, count in 1u32..=4, exponent in 8u32..=13,
    ) {
        let split = SplitScheme::Practical { lambda };
        let cascades = CascadeSettings { count, map_size_px: 1 << exponent, split };
        let settings = ShadowSettings { distance_m, cascades, ..ShadowSettings::default() };
        prop_assert_eq!(read(&ron::to_string(&settings).unwrap()), Ok(settings));
    }
}
