//! Settings: ranges, files, messages.

use proptest::prelude::*;
use shadowgraph_scene::{ByName, MaterialCasts, MaterialShadows, ObjectShadows, ShadowCasting};
use shadowgraph_shadows::{
    BiasMethod, BiasSettings, CascadeBlend, CascadeFitting, CascadeSelection, CascadeSettings, DepthFormat,
    DistanceMeasure, LightRef, LightShadows, NormalBias, ShadowFilter, ShadowSettings, SplitScheme,
};

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
        ("(distance_m: -1.0)", "invalid value: `distance_m` is -1; allowed: 0.001 to 1000000 (metres)"),
        ("(distance_m: NaN)", "invalid value: `distance_m` is NaN; allowed: 0.001 to 1000000 (metres)"),
        (
            "(fade_fraction: 1.5)",
            "invalid value: `fade_fraction` is 1.5; allowed: 0.001 to 1 (fraction of the distance)",
        ),
        ("(cascades: (count: 9))", "invalid value: `cascades.count` is 9; allowed: 0 to 8"),
        ("(cascades: (lights: 0))", "invalid value: `cascades.lights` is 0; allowed: 1 to 4"),
        (
            "(cascades: (overlap: 0.6))",
            "invalid value: `cascades.overlap` is 0.6; allowed: 0 to 0.5 (fraction of the slice's length)",
        ),
        (
            "(cascades: (blend: Soft(0.7)))",
            "invalid value: `cascades.blend` is 0.7; allowed: 0.001 to 0.5 (fraction of the cascade)",
        ),
        (
            "(cascades: (edge_fade: -1.0))",
            "invalid value: `cascades.edge_fade` is -1; allowed: 0 to 1 (fraction of the last cascade)",
        ),
        (
            "(cascades: (far_filter: 0.0))",
            "invalid value: `cascades.far_filter` is 0; allowed: 0.2 to 1 (fraction of the filter's width)",
        ),
        (
            "(cascades: (near_offset_m: inf))",
            "invalid value: `cascades.near_offset_m` is inf; allowed: 0 to 10000 (metres)",
        ),
        (
            "(cascades: (bias_scales: [1.0, NaN]))",
            "invalid value: `cascades.bias_scales` is NaN; allowed: a list, each 0 to 16",
        ),
        (
            "(cascades: (split: Metres([10.0, 5.0, 20.0])))",
            "invalid value: `cascades.split` is [10.0, 5.0, 20.0] for 4 cascades; \
             allowed: a list, each 0 to 1000000 (metres), one fewer than cascades, above 0, increasing",
        ),
        ("(cascades: (split: Factor(1.0)))", "invalid value: `cascades.split` is 1; allowed: 1.01 to 100"),
        (
            "(cascades: (split: Geometric(first_m: 0.0)))",
            "invalid value: `cascades.split.first_m` is 0; allowed: 0.001 to 100000 (metres)",
        ),
        (
            "(lights: [(light: 0, strength: 1.5)])",
            "invalid value: `lights.0.strength` is 1.5; allowed: 0 to 1",
        ),
        (
            "(lights: [(light: 0, near_m: Some(0.0))])",
            "invalid value: `lights.0.near_m` is 0; allowed: 0.0001 to 10000 (metres)",
        ),
        (
            "(lights: [(light: \"lamp\", importance: -1.0)])",
            "invalid value: `lights.0.importance` is -1; allowed: 0 to 100",
        ),
        (
            "(cascades: (map_size_px: 1000))",
            "invalid value: `cascades.map_size_px` is 1000; allowed: 256, 512, 1024, 2048, 4096 or 8192 (pixels)",
        ),
        (
            "(atlas: (map_size_px: 16384))",
            "invalid value: `atlas.map_size_px` is 16384; allowed: 256, 512, 1024, 2048, 4096 or 8192 (pixels)",
        ),
        (
            "(atlas: (spot_near_m: 0.0))",
            "invalid value: `atlas.spot_near_m` is 0; allowed: 0.0001 to 100 (metres)",
        ),
        (
            "(cascades: (split: Ratios([0.2, 0.1, 0.5])))",
            "invalid value: `cascades.split` is [0.2, 0.1, 0.5] for 4 cascades; \
             allowed: a list, each 0 to 1, one fewer than cascades, above 0, increasing, below 1",
        ),
        (
            "(cascades: (split: Practical(lambda: 2.0)))",
            "invalid value: `cascades.split.lambda` is 2; allowed: 0 to 1",
        ),
        (
            "(bias: (normal_texels: 9.0))",
            "invalid value: `bias.normal_texels` is 9; allowed: 0 to 4 (texels)",
        ),
        (
            "(bias: (slope: inf))",
            "invalid value: `bias.slope` is inf; allowed: 0 to 4 (times the receiver's slope)",
        ),
        (
            "(bias: (min_slope: -0.1))",
            "invalid value: `bias.min_slope` is -0.1; allowed: 0 to 4 (texels of depth per texel)",
        ),
        (
            "(bias: (max_slope: 0.5))",
            "invalid value: `bias.max_slope` is 0.5; allowed: 1 to 100 (texels of depth per texel)",
        ),
        (
            "(bias: (depth_texels: 17.0))",
            "invalid value: `bias.depth_texels` is 17; allowed: 0 to 16 (texels)",
        ),
    ] {
        assert_eq!(read(text).unwrap_err(), expected, "{text}");
    }
}

#[test]
fn a_light_is_named_by_its_number_or_its_name() {
    read("(lights: [(light: 3), (light: \"lamp\")])").unwrap();
    for text in ["(lights: [(light: -1)])", "(lights: [(light: 0.5)])"] {
        let error = read(text).unwrap_err();
        assert!(error.contains("`light` must be a light's number from 0, or its name in quotes"), "{error}");
    }
}

#[test]
fn ratios_must_fit_the_number_of_cascades() {
    assert!(read("(cascades: (count: 1, split: Ratios([])))").is_ok());
    for text in ["Ratios([])", "Ratios([0.1, 0.2])", "Ratios([0.1, 0.2, 1.0])", "Ratios([0.0, 0.2, 0.3])"] {
        assert!(read(&format!("(cascades: (split: {text}))")).is_err(), "{text}");
    }
}

fn any_split(count: u32) -> impl Strategy<Value = SplitScheme> {
    let ends = |scale: f32| (1..count).map(move |i| scale * i as f32 / count as f32).collect::<Vec<_>>();
    prop_oneof![
        Just(SplitScheme::Standard),
        Just(SplitScheme::Ratios(ends(1.0))),
        Just(SplitScheme::Metres(ends(90.0))),
        (1.01f32..100.0).prop_map(SplitScheme::Factor),
        (0.001f32..1e5).prop_map(|first_m| SplitScheme::Geometric { first_m }),
        Just(SplitScheme::Logarithmic),
        (0f32..=1.0).prop_map(|lambda| SplitScheme::Practical { lambda }),
    ]
}

prop_compose! {
    fn any_cascades()(count in 1u32..=8)(
        split in any_split(count), count in Just(count), lights in 1u32..=4, exponent in 8u32..=13,
        depth in prop::sample::select(&DepthFormat::ALL[..]),
        overlap in 0f32..=0.5, fit in prop::sample::select(vec![CascadeFitting::Stable, CascadeFitting::Tight]),
        select in prop::sample::select(vec![CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth]),
        blend in prop_oneof![
            Just(CascadeBlend::Hard),
            (0.001f32..=0.5).prop_map(CascadeBlend::Soft),
            (0.001f32..=0.5).prop_map(CascadeBlend::Dither),
        ],
        numbers in (0f32..=1.0, 0.2f32..=1.0, 0f32..=1e4, 0f32..=1e5),
        filter in prop::sample::select(&ShadowFilter::ALL[..]),
        bias_scales in prop::collection::vec(0f32..=16.0, 0..4),
    ) -> CascadeSettings {
        let (edge_fade, far_filter, near_offset_m, begin_m) = numbers;
        CascadeSettings {
            count, lights, map_size_px: 1 << exponent, cache: exponent == 9, depth, split, overlap, fit, select, blend,
            edge_fade, far_filter, near_offset_m, begin_m, filter, bias_scales, branch_free: exponent == 10,
        }
    }
}

prop_compose! {
    fn any_light()(
        light in prop_oneof![(0u32..9).prop_map(LightRef::Index), ".{0,9}".prop_map(LightRef::Name)],
        casts in any::<bool>(), strength in 0f32..=1.0,
        filter in prop::option::of(prop::sample::select(&ShadowFilter::ALL[..])),
        depth_texels in prop::option::of(0f32..=16.0), slope in prop::option::of(0f32..=4.0),
        normal_texels in prop::option::of(0f32..=4.0), near_m in prop::option::of(1e-4f32..=1e4),
        importance in 0f32..=100.0,
    ) -> LightShadows {
        LightShadows { light, casts, strength, filter, depth_texels, slope, normal_texels, near_m, importance }
    }
}

prop_compose! {
    fn any_material()(
        casts in prop::option::of(prop_oneof![Just(MaterialCasts::On), (0f32..=1.0).prop_map(MaterialCasts::Clip), Just(MaterialCasts::Off)]),
        receives in prop::option::of(any::<bool>()),
    ) -> MaterialShadows {
        MaterialShadows { casts, receives }
    }
}

proptest! {
    #[test]
    fn row_25_valid_settings_survive_a_round_trip(
        distance_m in 0.001f32..1e6, cascades in any_cascades(), lights in prop::collection::vec(any_light(), 0..3),
        normal in prop::sample::select(vec![NormalBias::Sine, NormalBias::Filter]),
        measure in prop::sample::select(vec![DistanceMeasure::ViewDepth, DistanceMeasure::Radius]),
        method in prop::sample::select(vec![BiasMethod::Plane, BiasMethod::Slope, BiasMethod::Gradient, BiasMethod::Raster]),
        materials in prop::collection::vec((".{0,9}", any_material()), 0..3),
        casts in prop::option::of(prop::sample::select(vec![ShadowCasting::On, ShadowCasting::Off, ShadowCasting::ShadowOnly])),
    ) {
        let objects = ByName(vec![("*".into(), ObjectShadows { casts, receives: None })]);
        let bias = BiasSettings { normal, method, ..BiasSettings::default() };
        let materials = ByName(materials);
        let settings = ShadowSettings { distance_m, measure, cascades, bias, lights, materials, objects, ..ShadowSettings::default() };
        prop_assert_eq!(read(&ron::to_string(&settings).unwrap()), Ok(settings));
    }
}
