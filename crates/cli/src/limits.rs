//! What values a setting may have, found out by trying: the checks themselves are asked, so what `nodes` and the window say is what
//! they hold to, for techniques of other crates too.

use std::collections::BTreeMap;

use serde_json::Value;

use shadowgraph::shadows::{OwnSettings, ShadowSettings, Techniques};

/// What a setting may be.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Limit {
    /// Lowest and highest number.
    pub(crate) range: Option<(f64, f64)>,
    /// The range and its unit in words, as the check says them.
    pub(crate) allowed: String,
    /// Whether numbers are whole.
    pub(crate) whole: bool,
    /// Names to choose from, with a value for each of which one was found that is taken now.
    pub(crate) variants: Vec<(String, Value)>,
    /// All names.
    pub(crate) names: Vec<String>,
}

/// Limits by the setting's path.
#[derive(Default)]
pub(crate) struct Limits(BTreeMap<String, Limit>);

/// Checks settings; an error says what is wrong.
pub(crate) type Check<'c> = &'c dyn Fn(&Value) -> Result<(), String>;

impl Limits {
    /// Returns what the value at `path` (a JSON pointer) of `root` may be.
    pub(crate) fn of(&mut self, root: &Value, path: &str, check: Check<'_>) -> &Limit {
        self.0.entry(path.to_owned()).or_insert_with(|| find(root, path, check))
    }
}

/// The settings that all techniques share, as JSON.
pub(crate) fn shared(settings: &ShadowSettings) -> Result<Value, serde_json::Error> {
    let settings = ShadowSettings { techniques: OwnSettings::default(), ..settings.clone() };
    let mut value = serde_json::to_value(settings)?;
    if let Some(fields) = value.as_object_mut() {
        fields.remove("techniques");
    }
    Ok(value)
}

/// Checks them.
pub(crate) fn check_shared(value: &Value) -> Result<(), String> {
    let read: ShadowSettings = serde_json::from_value(value.clone()).map_err(|error| error.to_string())?;
    read.validate().map_err(|error| error.to_string())
}

/// Checks the settings of one technique.
pub(crate) fn check_own(
    techniques: &Techniques,
    name: &str,
    settings: &ShadowSettings,
    value: &Value,
) -> Result<(), String> {
    let set = techniques.set_own_settings(name, &mut settings.clone(), value.clone());
    set.map_err(|error| error.to_string())
}

/// Every setting with what it may be, by its path, in the order of the value's fields.
pub(crate) fn rows(root: &Value, check: Check<'_>) -> Vec<(String, Limit)> {
    let mut limits = Limits::default();
    let mut found = Vec::new();
    collect(root, "", check, &mut limits, &mut found);
    found
}

fn collect(
    root: &Value,
    path: &str,
    check: Check<'_>,
    limits: &mut Limits,
    found: &mut Vec<(String, Limit)>,
) {
    let Some(value) = root.pointer(path) else { return };
    let limit = if path.is_empty() { Limit::default() } else { limits.of(root, path, check).clone() };
    match value {
        Value::Object(fields) if limit.names.is_empty() => {
            for name in fields.keys() {
                collect(root, &format!("{path}/{name}"), check, limits, found);
            }
        }
        _ => found.push((path.trim_start_matches('/').replace('/', "."), limit)),
    }
}

impl Limit {
    /// What it may be, in words; empty where that is not known. `(...)` follows names that have values.
    pub(crate) fn words(&self) -> String {
        if self.names.is_empty() {
            return self.allowed.clone();
        }
        let has_values =
            |name: &String| self.variants.iter().any(|(of, value)| of == name && !value.is_string());
        let form = |name: &String| if has_values(name) { format!("{name}(...)") } else { name.clone() };
        format!("one of {}", self.names.iter().map(form).collect::<Vec<_>>().join(", "))
    }
}

fn find(root: &Value, path: &str, check: Check<'_>) -> Limit {
    let error = |value: Value| {
        let mut tried = root.clone();
        match tried.pointer_mut(path) {
            Some(place) => *place = value,
            None => return String::new(),
        }
        check(&tried).err().unwrap_or_default()
    };
    match root.pointer(path) {
        Some(Value::Number(_)) => {
            // Far above what any setting allows, yet a number of every kind.
            let allowed = allowed(&error(4_000_000_000_u32.into()));
            let whole = error(serde_json::json!(0.5)).contains("invalid type");
            Limit {
                range: allowed.as_deref().and_then(range),
                allowed: allowed.unwrap_or_default(),
                whole,
                ..Limit::default()
            }
        }
        Some(Value::String(_) | Value::Object(_)) => {
            let names = names(&error("?".into()));
            let value = |name: String| {
                let value = variant(&name, &error)?;
                Some((name, value))
            };
            let variants = names.iter().cloned().filter_map(value).collect();
            Limit { variants, names, ..Limit::default() }
        }
        _ => Limit::default(),
    }
}

/// What follows `allowed: ` or the like in an error of a check.
fn allowed(error: &str) -> Option<String> {
    let (_, allowed) = error.rsplit_once("allowed: ").or_else(|| error.rsplit_once("; it can be "))?;
    Some(allowed.to_owned())
}

/// The two ends of `1 to 64 (texels)`.
fn range(allowed: &str) -> Option<(f64, f64)> {
    let (low, rest) = allowed.split_once(" to ")?;
    let high: String =
        rest.chars().take_while(|char| char.is_ascii_digit() || ".-e".contains(*char)).collect();
    Some((low.trim().parse().ok()?, high.trim_end_matches('.').parse().ok()?))
}

/// The names that serde lists where it knows none of `?`.
fn names(error: &str) -> Vec<String> {
    let Some((_, names)) = error.split_once("unknown variant `?`, expected ") else { return Vec::new() };
    names.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

/// The first value of a variant that is taken.
fn variant(name: &str, error: &dyn Fn(Value) -> String) -> Option<Value> {
    let payloads = [
        Value::Null,
        0.5.into(),
        1.into(),
        2.0.into(),
        serde_json::json!([0.1, 0.3, 0.6]),
        serde_json::json!([0.5, 0.5]),
        Value::String(String::new()),
    ];
    let plain = Value::String(name.to_owned());
    let with = payloads.into_iter().map(|payload| serde_json::json!({ name: payload }));
    let found = std::iter::once(plain).chain(with).find(|value| error(value.clone()).is_empty());
    found.or_else(|| [0.5.into(), 64.into()].into_iter().find_map(|fill| with_fields(name, &fill, error)))
}

/// A variant with fields: those that are missed are added.
fn with_fields(name: &str, fill: &Value, error: &dyn Fn(Value) -> String) -> Option<Value> {
    let mut fields = serde_json::Map::new();
    for _ in 0..8 {
        let value = serde_json::json!({ name: fields });
        let problem = error(value.clone());
        match problem.split_once("missing field `").and_then(|(_, rest)| rest.split_once('`')) {
            Some((field, _)) => fields.insert(field.to_owned(), fill.clone()),
            None => return problem.is_empty().then_some(value),
        };
    }
    None
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn ranges_units_and_names_are_those_of_the_checks() {
        let root = shared(&ShadowSettings::default()).unwrap();
        let mut limits = Limits::default();
        let distance = limits.of(&root, "/distance_m", &check_shared).clone();
        assert_eq!((distance.range, &*distance.allowed), (Some((0.001, 1e6)), "0.001 to 1000000 (metres)"));
        let count = limits.of(&root, "/cascades/count", &check_shared).clone();
        assert!(count.whole && count.range == Some((0.0, 8.0)), "{count:?}");
        let split = limits.of(&root, "/cascades/split", &check_shared);
        let names: Vec<&str> = split.variants.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(
            names,
            ["Standard", "Ratios", "Metres", "Factor", "Geometric", "Logarithmic", "Practical"]
        );
        for (_, value) in split.variants.clone() {
            let mut tried = root.clone();
            *tried.pointer_mut("/cascades/split").unwrap() = value;
            assert_eq!(check_shared(&tried), Ok(()));
        }
    }

    #[test]
    fn settings_of_single_techniques_have_limits_too() {
        let techniques = Techniques::built_in();
        let settings = ShadowSettings::default();
        let root = techniques.own_settings("pcss", &settings).unwrap().unwrap();
        let check = |value: &Value| check_own(&techniques, "pcss", &settings, value);
        let taps = Limits::default().of(&root, "/filter_taps", &check).clone();
        assert_eq!((taps.range, taps.whole), (Some((1.0, 64.0)), true));
    }

    #[test]
    fn all_settings_are_told_with_what_they_may_be() {
        let root = shared(&ShadowSettings::default()).unwrap();
        let rows = rows(&root, &check_shared);
        let of = |name: &str| rows.iter().find(|(path, _)| path == name).unwrap().1.words();
        assert_eq!(of("cascades.count"), "0 to 8");
        assert_eq!(of("atlas.tiles"), "one of Even, ByImportance(...)");
        assert!(of("cascades.split").starts_with("one of Standard, Ratios"));
        let untold: Vec<&str> = rows
            .iter()
            .filter(|(path, limit)| {
                let value = root.pointer(&format!("/{}", path.replace('.', "/"))).unwrap();
                value.is_number() && limit.words().is_empty()
            })
            .map(|(path, _)| &**path)
            .collect();
        assert!(untold.is_empty(), "{untold:?}");
        // The window can go from each variant to each other.
        let lost = rows.iter().find(|(_, limit)| limit.variants.len() != limit.names.len());
        assert_eq!(lost, None);
    }
}
