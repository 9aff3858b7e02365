//! Settings over time and place.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::{Number, Value};

use super::ShadowSettings;
use crate::error::Error;

/// Shadow settings that change with time and with the place of the camera. Settings are named by their path, such as `distance_m`,
/// `cascades.split.lambda` or `lights.0.strength`; those of techniques cannot change.
///
/// Fractional numbers are interpolated; whole numbers, toggles and names of variants change at the key frame, or half-way into a zone.
///
/// ```
/// use glam::DVec3;
/// use shadowgraph_shadows::{SettingTracks, ShadowSettings};
/// let tracks: SettingTracks = ron::from_str(r#"(
///     tracks: [(setting: "distance_m", keys: [(0.0, 40.0), (10.0, 80.0)])],
///     zones: [(center: (0.0, 0.0, 0.0), radius_m: 5.0, blend_m: 10.0, settings: {"fade_fraction": 0.5})],
/// )"#)?;
/// let base = ShadowSettings::default();
/// tracks.check(&base)?;
/// let settings = tracks.settings_for(&base, 2.5, DVec3::X * 10.0)?;
/// assert_eq!((settings.distance_m, settings.fade_fraction), (50.0, 0.3));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SettingTracks {
    /// Settings over time.
    pub tracks: Vec<SettingTrack>,
    /// Settings of parts of the world, applied after the tracks and in this order.
    pub zones: Vec<SettingZone>,
}

/// One setting over time. Before the first key frame it has the value of that, and after the last the value of the last.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettingTrack {
    /// The path of the setting.
    pub setting: String,
    /// The key frames: times in seconds, ascending, and values.
    pub keys: Vec<(f64, TrackValue)>,
}

/// The settings of a part of the world, by the camera's position.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SettingZone {
    /// The centre of the zone, world space, metres.
    pub center: (f64, f64, f64),
    /// Radius inside which its settings apply, metres, 0 or more.
    pub radius_m: f64,
    /// Distance outside the radius over which they fade to those of the surroundings, metres, 0 or more.
    #[serde(default)]
    pub blend_m: f64,
    /// The settings, by path.
    pub settings: BTreeMap<String, TrackValue>,
}

/// The value of a setting.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number, true, false, or the name of a variant in quotes")]
pub enum TrackValue {
    /// A toggle.
    Toggle(bool),
    /// A number.
    Number(f64),
    /// The name of a variant without fields.
    Name(String),
}

impl SettingTracks {
    /// Checks every path, time and value, for settings that the tracks do not change.
    ///
    /// # Errors
    /// [`Error::Setting`] names the first value that is not allowed.
    pub fn check(&self, base: &ShadowSettings) -> Result<(), Error> {
        for (i, track) in self.tracks.iter().enumerate() {
            let field = format!("tracks.{i}.keys");
            if track.keys.is_empty() {
                return Err(refused(field, "empty", "one key frame or more"));
            }
            let times = || track.keys.iter().map(|(time_s, _)| *time_s);
            if !times().all(f64::is_finite) || !times().is_sorted_by(|a, b| a < b) {
                let times: Vec<_> = times().map(|time| time.to_string()).collect();
                return Err(refused(field, &times.join(", "), "finite times in ascending order (seconds)"));
            }
            for (_, value) in &track.keys {
                check_value(base, &track.setting, value)
                    .map_err(|error| error.inside(&format!("tracks.{i}")))?;
            }
        }
        for (i, zone) in self.zones.iter().enumerate() {
            let inside = |error: Error| error.inside(&format!("zones.{i}"));
            let (x, y, z) = zone.center;
            for (name, value, is_allowed) in [
                ("center", x + y + z, (x + y + z).is_finite()),
                ("radius_m", zone.radius_m, zone.radius_m.is_finite() && zone.radius_m >= 0.0),
                ("blend_m", zone.blend_m, zone.blend_m.is_finite() && zone.blend_m >= 0.0),
            ] {
                if !is_allowed {
                    let allowed =
                        if name == "center" { "finite coordinates (metres)" } else { "0 or more (metres)" };
                    return Err(inside(refused(name.to_owned(), &value.to_string(), allowed)));
                }
            }
            for (setting, value) in &zone.settings {
                check_value(base, setting, value).map_err(inside)?;
            }
        }
        Ok(())
    }

    /// Returns the time of the last key frame, seconds; 0 without key frames.
    #[must_use]
    pub fn end_s(&self) -> f64 {
        let ends = self.tracks.iter().filter_map(|track| track.keys.last());
        ends.fold(0.0, |end_s, (time_s, _)| time_s.max(end_s))
    }

    /// Returns the settings at a time, in seconds, for a camera at a position in the world. `base` has those that the tracks do not change.
    ///
    /// # Errors
    /// As [`check`](Self::check), but for values that are not used at this time and place.
    pub fn settings_for(
        &self,
        base: &ShadowSettings,
        time_s: f64,
        eye_world: DVec3,
    ) -> Result<ShadowSettings, Error> {
        if self.tracks.is_empty() && self.zones.is_empty() {
            return Ok(base.clone());
        }
        let mut values = to_json(base);
        for track in &self.tracks {
            let Some((from, to, weight)) = track.between(time_s) else { continue };
            let target = find(&mut values, &track.setting)?;
            let [from, to] = [from, to].map(|value| replaced(target, &track.setting, value));
            *target = mix(&from?, &to?, weight, 1.0);
        }
        for zone in &self.zones {
            let weight = zone.weight(eye_world);
            for (setting, value) in zone.settings.iter().filter(|_| weight > 0.0) {
                let target = find(&mut values, setting)?;
                *target = mix(target, &replaced(target, setting, value)?, weight, 0.5);
            }
        }
        from_json(values, base)
    }
}

impl SettingTrack {
    /// Returns the values around a time, and the weight of the second.
    fn between(&self, time_s: f64) -> Option<(&TrackValue, &TrackValue, f64)> {
        let next = self.keys.partition_point(|(at, _)| *at <= time_s);
        let (Some((end_s, to)), Some((begin_s, from))) =
            (self.keys.get(next), self.keys.get(next.wrapping_sub(1)))
        else {
            let (_, only) = self.keys.get(next).or(self.keys.last())?;
            return Some((only, only, 0.0));
        };
        Some((from, to, (time_s - begin_s) / (end_s - begin_s)))
    }
}

impl SettingZone {
    /// Returns the weight of its settings at a position, 0 to 1.
    fn weight(&self, eye_world: DVec3) -> f64 {
        let outside_m = eye_world.distance(self.center.into()) - self.radius_m;
        if outside_m <= 0.0 { 1.0 } else { (1.0 - outside_m / self.blend_m).max(0.0) }
    }
}

/// Checks a value in place of that of `base`.
fn check_value(base: &ShadowSettings, setting: &str, value: &TrackValue) -> Result<(), Error> {
    let mut values = to_json(base);
    let target = find(&mut values, setting)?;
    *target = replaced(target, setting, value)?;
    from_json(values, base).map(drop)
}

/// Returns the settings that can change.
fn to_json(settings: &ShadowSettings) -> Value {
    let plain = ShadowSettings { techniques: Default::default(), ..settings.clone() };
    let mut values = super::json(&plain);
    values.as_object_mut().into_iter().for_each(|fields| fields.retain(|name, _| !is_left_out(name)));
    values
}

/// Returns whether the settings in a field cannot change.
fn is_left_out(name: &str) -> bool {
    matches!(name, "techniques" | "materials" | "objects")
}

fn from_json(values: Value, base: &ShadowSettings) -> Result<ShadowSettings, Error> {
    let read = serde_json::from_value::<ShadowSettings>(values);
    let settings =
        read.map_err(|error| refused("settings".to_owned(), &error.to_string(), "a shadow setting"))?;
    let (techniques, materials, objects) =
        (base.techniques.clone(), base.materials.clone(), base.objects.clone());
    let settings = ShadowSettings { techniques, materials, objects, ..settings };
    settings.validate().map(|()| settings)
}

/// Returns the value of a setting. The name of a variant need not be a part of its path.
fn find<'v>(values: &'v mut Value, setting: &str) -> Result<&'v mut Value, Error> {
    let unknown = || {
        refused(
            "setting".to_owned(),
            setting,
            "the path of a shadow setting, as distance_m or cascades.count",
        )
    };
    let found = setting.split('.').try_fold(values, |value, name| match value {
        Value::Object(fields) => {
            let is_variant = fields.len() == 1 && !fields.contains_key(name);
            if is_variant { fields.values_mut().next()?.get_mut(name) } else { fields.get_mut(name) }
        }
        Value::Array(values) => values.get_mut(name.parse::<usize>().ok()?),
        _ => None,
    });
    found.ok_or_else(unknown)
}

/// Returns a value for a setting that has another one.
fn replaced(present: &Value, setting: &str, value: &TrackValue) -> Result<Value, Error> {
    let wrong = |found: &dyn std::fmt::Display, allowed| {
        Err(refused(setting.to_owned(), &found.to_string(), allowed))
    };
    match (present, value) {
        (Value::Bool(_), TrackValue::Toggle(value)) => Ok(Value::Bool(*value)),
        (Value::Bool(_), other) => wrong(other, "true or false"),
        (Value::Number(number), TrackValue::Number(value)) if number.is_f64() => {
            Ok(Number::from_f64(*value).map_or(Value::Null, Value::Number))
        }
        (Value::Number(_), TrackValue::Number(value)) if value.fract() == 0.0 && *value >= 0.0 => {
            Ok(Value::Number((*value as u64).into()))
        }
        (Value::Number(number), other) => {
            wrong(other, if number.is_f64() { "a number" } else { "a whole number" })
        }
        (Value::String(_), TrackValue::Name(value)) => Ok(Value::String(value.clone())),
        (Value::String(_), other) => wrong(other, "the name of a variant without fields, in quotes"),
        (_, other) => wrong(other, "a setting that is a number, a toggle or a name"),
    }
}

impl std::fmt::Display for TrackValue {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Toggle(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
            Self::Name(value) => write!(f, "{value:?}"),
        }
    }
}

/// Interpolates fractional numbers; of other values, selects the second from this weight on.
fn mix(from: &Value, to: &Value, weight: f64, change: f64) -> Value {
    match (from, to) {
        (Value::Number(a), Value::Number(b)) if a.is_f64() => match (a.as_f64(), b.as_f64()) {
            (Some(a), Some(b)) => Number::from_f64(a + (b - a) * weight).map_or(Value::Null, Value::Number),
            _ => from.clone(),
        },
        _ => if weight < change { from } else { to }.clone(),
    }
}

fn refused(field: String, value: &str, allowed: &str) -> Error {
    Error::Setting { field, value: value.to_owned(), allowed: allowed.to_owned() }
}
