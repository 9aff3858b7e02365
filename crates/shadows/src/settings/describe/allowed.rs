//! The values that settings allow.

use serde_json::Value;

use super::{Payload, Setting, SettingType, Variant};
use crate::error::Error;

impl Setting {
    /// Returns the allowed values with their unit, such as `0 to 10 (metres)`.
    pub fn allowed(&self) -> String {
        let mut allowed = self.ty.allowed();
        if !self.unit.is_empty() {
            allowed += &format!(" ({})", self.unit);
        }
        if !self.note.is_empty() {
            allowed += &format!(", {}", self.note);
        }
        allowed
    }

    /// Checks a value.
    ///
    /// # Errors
    /// The value and what is allowed, in one line.
    pub fn check(&self, value: &Value) -> Result<(), String> {
        if self.ty.allows(value) {
            return Ok(());
        }
        let kind = match self.ty {
            SettingType::Integer(..) | SettingType::PowerOfTwo(..) if value.as_i64().is_none() => {
                "an integer, "
            }
            SettingType::Number(..) if !value.is_number() => "a number, ",
            _ => "",
        };
        Err(format!("{} is {value}; allowed: {kind}{}", self.name, self.allowed()))
    }
}

impl SettingType {
    /// Returns the allowed values, without a unit.
    pub fn allowed(&self) -> String {
        match self {
            Self::Toggle(_) => "true or false".into(),
            Self::Integer(_, low, high) => format!("{low} to {high}"),
            Self::Number(_, low, high) => format!("{low} to {high}"),
            Self::PowerOfTwo(_, low, high) => powers_of_two(*low, *high),
            Self::Choice(_, names) => format!("one of {}", names.join(", ")),
            Self::Text(_) => "a string".into(),
            Self::Color(_) => "three numbers of 0 or more, such as (1.0, 0.5, 0.0)".into(),
            Self::Enum(_, variants) => {
                format!("one of {}", variants.iter().map(Variant::form).collect::<Vec<_>>().join(", "))
            }
            Self::Struct(_) => "a struct".into(),
            Self::List(_, item) => format!("a list, each {}", item.allowed()),
            Self::Optional(inner) => match inner {
                Self::Enum(..) => {
                    format!("None, or Some of {}", inner.allowed().trim_start_matches("one of "))
                }
                _ => format!("None, or Some({})", inner.allowed()),
            },
            Self::Other(_, words) => (*words).into(),
        }
    }

    /// Whether a value is allowed. Notes are not checked.
    pub fn allows(&self, value: &Value) -> bool {
        match self {
            Self::Toggle(_) => value.is_boolean(),
            Self::Integer(_, low, high) => {
                value.as_i64().is_some_and(|value| (*low..=*high).contains(&value))
            }
            Self::PowerOfTwo(_, low, high) => {
                value.as_u64().is_some_and(u64::is_power_of_two)
                    && value.as_i64().is_some_and(|value| (*low..=*high).contains(&value))
            }
            Self::Number(_, low, high) => value.as_f64().is_some_and(|value| (*low..=*high).contains(&value)),
            Self::Choice(_, names) => value.as_str().is_some_and(|value| names.contains(&value)),
            Self::Text(_) => value.is_string(),
            Self::Color(_) => color(value).is_some(),
            Self::Enum(_, variants) => variants.iter().any(|variant| variant.allows(value)),
            Self::Struct(fields) => allow(fields, value),
            Self::List(_, item) => {
                value.as_array().is_some_and(|items| items.iter().all(|value| item.allows(value)))
            }
            Self::Optional(inner) => value.is_null() || inner.allows(value),
            Self::Other(..) => true,
        }
    }
}

impl Variant {
    /// Whether a value is this variant and what it carries is allowed.
    fn allows(&self, value: &Value) -> bool {
        match self.payload {
            Payload::Empty => value.as_str() == Some(self.name),
            Payload::Value(setting) => value.get(self.name).is_some_and(|value| setting.ty.allows(value)),
            Payload::Fields(fields) => value.get(self.name).is_some_and(|value| allow(fields, value)),
        }
    }

    /// Returns the variant with the values that it may carry.
    fn form(&self) -> String {
        match self.payload {
            Payload::Empty => self.name.into(),
            Payload::Value(setting) => format!("{}({})", self.name, setting.allowed()),
            Payload::Fields(fields) => {
                let field = |setting: &Setting| format!("{}: {}", setting.name, setting.allowed());
                format!("{}({})", self.name, fields.iter().map(field).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

impl Error {
    /// Returns the error that a setting has a value that it does not allow.
    pub fn invalid(setting: &Setting, value: impl ToString) -> Self {
        Self::Setting { field: setting.name.to_owned(), value: value.to_string(), allowed: setting.allowed() }
    }
}

/// Returns the error that a value is not what the setting at `path` allows. The last part of the path may be a variant with a value.
pub(crate) fn refused(settings: &'static [Setting], path: &str, value: impl ToString) -> Error {
    let (mut known, mut found) = (settings, None);
    let mut field = Vec::new();
    for name in path.split('.') {
        found = known
            .iter()
            .find(|setting| setting.name == name)
            .or(found.and_then(|setting| payload(setting, name)));
        let Some(setting) = found else { break };
        if !setting.name.is_empty() {
            field.push(setting.name);
        }
        known = match setting.ty {
            SettingType::Struct(fields) => fields,
            _ => &[],
        };
    }
    let allowed = found.map(Setting::allowed).unwrap_or_default();
    Error::Setting { field: field.join("."), value: value.to_string(), allowed }
}

/// Returns the field of this name of any variant, or the value of the variant of this name.
fn payload(setting: &Setting, name: &str) -> Option<&'static Setting> {
    let SettingType::Enum(_, variants) = setting.ty else { return None };
    variants.iter().find_map(|variant| match variant.payload {
        Payload::Value(setting) if variant.name == name => Some(setting),
        Payload::Fields(fields) => fields.iter().find(|setting| setting.name == name),
        _ => None,
    })
}

fn allow(fields: &[Setting], value: &Value) -> bool {
    fields.iter().all(|setting| value.get(setting.name).is_none_or(|value| setting.ty.allows(value)))
}

/// Reads a colour: three numbers from 0 to 1,000,000.
pub fn color(value: &Value) -> Option<[f64; 3]> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    let color: [f64; 3] = numbers?.try_into().ok()?;
    color.iter().all(|part| (0.0..=1e6).contains(part)).then_some(color)
}

pub(super) fn powers(low: i64, high: i64) -> impl Iterator<Item = i64> {
    (0..i64::BITS - 1).map(|exponent| 1 << exponent).filter(move |power| (low..=high).contains(power))
}

/// Returns the powers of two in words: `1, 2 or 4`.
fn powers_of_two(low: i64, high: i64) -> String {
    let powers: Vec<String> = powers(low, high).map(|power| power.to_string()).collect();
    match powers.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => powers.concat(),
    }
}
