//! Descriptions agree with the types that they describe.
#![allow(clippy::unwrap_used, clippy::panic, reason = "tests")]

use proptest::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::*;
use crate::budget::{BudgetConfig, QualityLevel};
use crate::registry::Techniques;

/// A struct of settings without its type: descriptions, defaults, and a check of JSON.
struct Declared {
    name: &'static str,
    settings: &'static [Setting],
    defaults: Value,
    check: Box<dyn Fn(Value) -> Result<(), String>>,
}

fn shared() -> Declared {
    let mut defaults = json(&ShadowSettings::default());
    defaults.as_object_mut().unwrap().remove("techniques");
    Declared {
        name: "",
        settings: ShadowSettings::SETTINGS,
        defaults,
        check: Box::new(|value| {
            let read: ShadowSettings = serde_json::from_value(value).map_err(|error| error.to_string())?;
            read.validate().map_err(|error| error.to_string())
        }),
    }
}

fn declared_struct<S: DescribeSettings + Default + Serialize + DeserializeOwned>(
    name: &'static str,
) -> Declared {
    Declared {
        name,
        settings: S::settings(),
        defaults: json(&S::default()),
        check: Box::new(|value| {
            let read: S = serde_json::from_value(value).map_err(|error| error.to_string())?;
            read.validate().map_err(|error| error.to_string())
        }),
    }
}

fn declared() -> Vec<Declared> {
    let techniques = Techniques::built_in();
    let names: Vec<&'static str> = techniques.with_settings().collect();
    let of_techniques = names.into_iter().map(|name| {
        let known = techniques.clone();
        Declared {
            name,
            settings: techniques.describe_settings(name),
            defaults: techniques.technique_settings(name, &ShadowSettings::default()).unwrap().unwrap(),
            check: Box::new(move |value| {
                let set = known.set_technique_settings(name, &mut ShadowSettings::default(), value);
                set.map_err(|error| error.to_string())
            }),
        }
    });
    let budget = [declared_struct::<BudgetConfig>("budget"), declared_struct::<QualityLevel>("level")];
    std::iter::once(shared()).chain(of_techniques).chain(budget).collect()
}

/// All settings below these that are not structs, with their paths as JSON pointers.
fn flat(settings: &'static [Setting], parent: &str) -> Vec<(String, &'static Setting)> {
    let below = settings.iter().filter(|setting| setting.name != "techniques").map(|setting| {
        let path = format!("{parent}/{}", setting.name);
        match setting.ty {
            SettingType::Struct(fields) => flat(fields, &path),
            _ => vec![(path, setting)],
        }
    });
    below.flatten().collect()
}

#[test]
fn every_field_is_described_with_its_default_and_in_its_order() {
    for Declared { name, settings, defaults, check } in declared() {
        let fields = |value: &Value| -> Vec<String> { value.as_object().unwrap().keys().cloned().collect() };
        let described = settings.iter().map(|setting| setting.name).filter(|name| *name != "techniques");
        let mut described: Vec<String> = described.map(str::to_owned).collect();
        let mut known = fields(&defaults);
        described.sort();
        known.sort();
        assert_eq!(known, described, "{name}");
        for (path, setting) in flat(settings, "") {
            let default = defaults.pointer(&path).unwrap_or_else(|| panic!("{name}{path} is no field"));
            assert_eq!(*default, setting.default_value(), "{name}{path}");
            assert!(setting.ty.allows(default), "{name}{path}");
            assert!(!setting.about.is_empty() && !setting.about.contains('\n'), "{name}{path}");
        }
        assert_eq!(check(defaults), Ok(()), "{name}");
    }
}

#[test]
fn entries_of_lights_are_described() {
    let names: Vec<&str> = LightShadows::SETTINGS.iter().map(|setting| setting.name).collect();
    let entry = json(&LightShadows::new(0.into()));
    let mut fields: Vec<&str> = entry.as_object().unwrap().keys().map(String::as_str).collect();
    fields.sort_unstable();
    let mut sorted = names.clone();
    sorted.sort_unstable();
    assert_eq!(fields, sorted);
    for setting in &LightShadows::SETTINGS[1..] {
        assert_eq!(entry[setting.name], setting.default_value(), "{}", setting.name);
    }
    assert_eq!(LightShadows::SETTINGS[0].describe().split(';').next(), Some("required"));
}

#[test]
fn limits_that_code_relies_on_are_those_of_the_declarations() {
    let high = |name: &str| match CascadeSettings::SETTINGS
        .iter()
        .find(|setting| setting.name == name)
        .unwrap()
        .ty
    {
        SettingType::Integer(_, _, high) => high,
        other => panic!("{other:?}"),
    };
    assert_eq!(high("count"), i64::from(MAX_CASCADES));
    assert_eq!(high("lights"), i64::from(MAX_CASCADE_LIGHTS));
}

#[test]
fn every_example_of_a_variant_is_valid() {
    let mut count = 0;
    for Declared { name, settings, defaults, check } in declared() {
        for (path, setting) in flat(settings, "") {
            let SettingType::Enum(_, variants) = setting.ty else { continue };
            for variant in variants {
                let mut tried = defaults.clone();
                *tried.pointer_mut(&path).unwrap() = variant.example();
                // The default exponents are too large for 16 bits.
                let is_valid = (name, variant.name) != ("evsm", "Half");
                assert_eq!(check(tried).is_ok(), is_valid, "{name}{path}: {}", variant.name);
                assert!(!variant.about.is_empty(), "{}", variant.name);
                count += 1;
            }
        }
    }
    assert!(count > 30, "{count}");
}

#[test]
fn allowed_values_are_described_with_units_and_conditions() {
    let allowed = |settings: &[Setting], name: &str| {
        settings.iter().find(|setting| setting.name == name).unwrap().allowed()
    };
    assert_eq!(allowed(ShadowSettings::SETTINGS, "distance_m"), "0.001 to 1000000 (metres)");
    assert_eq!(allowed(CascadeSettings::SETTINGS, "count"), "0 to 8");
    assert_eq!(allowed(CascadeSettings::SETTINGS, "cache"), "true or false");
    assert_eq!(
        allowed(CascadeSettings::SETTINGS, "map_size_px"),
        "256, 512, 1024, 2048, 4096 or 8192 (pixels)"
    );
    assert_eq!(
        allowed(CascadeSettings::SETTINGS, "blend"),
        "one of Hard, Soft(0.001 to 0.5 (fraction of the cascade)), Dither(0.001 to 0.5 (fraction of the cascade))"
    );
    assert_eq!(
        allowed(AtlasSettings::SETTINGS, "tiles"),
        "one of Even, ByImportance(smallest_px: 64, 128, 256, 512 or 1024 (pixels), at most a quarter of the map)"
    );
    assert_eq!(
        allowed(LightShadows::SETTINGS, "slope"),
        "None, or Some(0 to 4) (times the receiver's slope)"
    );
    assert_eq!(
        CascadeSettings::SETTINGS.iter().find(|setting| setting.name == "split").unwrap().default_ron(),
        "Practical(lambda: 0.85)"
    );
}

#[test]
fn defaults_written_as_ron_read_as_the_defaults() {
    let text = format!("({})", settings_file(ShadowSettings::SETTINGS, 1));
    assert_eq!(ron::from_str::<ShadowSettings>(&text).unwrap(), ShadowSettings::default());
}

#[test]
fn a_value_that_two_settings_allow_only_together_is_an_error_with_the_condition() {
    let error =
        |text: &str| ron::from_str::<ShadowSettings>(text).unwrap().validate().unwrap_err().to_string();
    assert_eq!(
        error("(atlas: (map_size_px: 256, tiles: ByImportance(smallest_px: 128)))"),
        "invalid value: `atlas.tiles.smallest_px` is 128; \
         allowed: 64, 128, 256, 512 or 1024 (pixels), at most a quarter of the map"
    );
}

#[test]
fn the_schema_has_every_setting_with_its_range() {
    let schema = Techniques::built_in().settings_schema();
    let cascades = &schema["properties"]["cascades"]["properties"];
    assert_eq!(cascades["count"]["minimum"], 0);
    assert_eq!(cascades["count"]["maximum"], 8);
    assert_eq!(cascades["filter"]["anyOf"][0]["const"], "Tent2");
    let pcss = &schema["properties"]["techniques"]["properties"]["pcss"]["properties"];
    assert_eq!(pcss["sun_radius_rad"]["maximum"], 0.2);
    assert_eq!(pcss["filter_taps"]["default"], 24);
    assert_eq!(schema["properties"]["lights"]["items"]["required"], serde_json::json!(["light"]));
}

/// A number around a range, the same in 32 bits.
fn near(low: f64, high: f64) -> impl Strategy<Value = f64> {
    let span = high - low;
    prop_oneof![Just(low), Just(high), low - span..high + span].prop_map(|value| f64::from(value as f32))
}

proptest! {
    #[test]
    fn exactly_the_values_of_a_range_are_valid(pick in any::<prop::sample::Index>(), part in 0.0..1.0f64) {
        let structs = declared();
        let all: Vec<_> = structs
            .iter()
            .flat_map(|declared| flat(declared.settings, "").into_iter().map(move |found| (declared, found)))
            .collect();
        let (declared, (path, setting)) = &all[pick.index(all.len())];
        let value: Value = match setting.ty {
            SettingType::Integer(_, _, high) => ((part * (2 * high + 2) as f64) as i64).into(),
            SettingType::PowerOfTwo(_, _, high) => ((part * (2 * high + 2) as f64) as i64).into(),
            SettingType::Number(_, low, high) => {
                let span = high - low;
                f64::from((low - span + part * 3.0 * span) as f32).into()
            }
            _ => return Ok(()),
        };
        let mut tried = declared.defaults.clone();
        *tried.pointer_mut(path).unwrap() = value.clone();
        let checked = (declared.check)(tried);
        match setting.ty.allows(&value) {
            true => prop_assert_eq!(checked, Ok(())),
            false => {
                let error = checked.unwrap_err();
                prop_assert!(error.contains(&setting.allowed()), "{error}");
                prop_assert!(error.contains(&path[1..].replace('/', ".")), "{error}");
            }
        }
    }

    #[test]
    fn numbers_at_the_ends_of_a_range_are_valid(value in near(0.0, 0.1)) {
        let settings = crate::EvsmSettings { bias: value as f32, ..crate::EvsmSettings::default() };
        prop_assert_eq!(settings.validate().is_ok(), (0.0..=0.1f32).contains(&(value as f32)));
    }
}
