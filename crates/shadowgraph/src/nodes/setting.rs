//! What of a node can be chosen: described, checked, read.

use serde_json::{Value, json};

use crate::error::Error;

/// One setting of a kind of node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setting {
    /// What it is called.
    pub name: &'static str,
    /// What it may be, and what it is if nothing is said.
    pub ty: SettingType,
    /// What it is measured in; empty for none.
    pub unit: &'static str,
    /// What it does, in a phrase.
    pub about: &'static str,
}

/// What a setting may be; each begins with the default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SettingType {
    /// Yes or no.
    Toggle(bool),
    /// A whole number from the second to the third.
    Integer(i64, i64, i64),
    /// A number from the second to the third.
    Number(f64, f64, f64),
    /// One of these.
    Choice(&'static str, &'static [&'static str]),
    /// Any text.
    Text(&'static str),
    /// Red, green and blue, linear, each at least 0.
    Color([f64; 3]),
}

impl Setting {
    /// Describes a setting without a unit.
    pub const fn new(name: &'static str, ty: SettingType, about: &'static str) -> Self {
        Self { name, ty, unit: "", about }
    }

    /// Says what it is measured in.
    #[must_use]
    pub const fn in_units(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

    /// Returns what it may be, in words.
    pub fn allowed(&self) -> String {
        let range = match self.ty {
            SettingType::Toggle(_) => return "true or false".into(),
            SettingType::Integer(_, low, high) => format!("a whole number from {low} to {high}"),
            SettingType::Number(_, low, high) => format!("a number from {low} to {high}"),
            SettingType::Choice(_, of) => return format!("one of {}", of.join(", ")),
            SettingType::Text(_) => return "a text".into(),
            SettingType::Color(_) => return "three numbers from 0 on, such as (1.0, 0.5, 0.0)".into(),
        };
        if self.unit.is_empty() { range } else { format!("{range} ({})", self.unit) }
    }

    /// Returns the default.
    pub fn default_value(&self) -> Value {
        match self.ty {
            SettingType::Toggle(value) => value.into(),
            SettingType::Integer(value, ..) => value.into(),
            SettingType::Number(value, ..) => value.into(),
            SettingType::Choice(value, _) | SettingType::Text(value) => value.into(),
            SettingType::Color(value) => json!(value),
        }
    }

    /// Says what is wrong with a value; `None` if nothing is.
    pub fn fault(&self, value: &Value) -> Option<String> {
        let number = |low: f64, high: f64| value.as_f64().is_some_and(|value| (low..=high).contains(&value));
        let fits = match self.ty {
            SettingType::Toggle(_) => value.is_boolean(),
            SettingType::Integer(_, low, high) => {
                value.as_i64().is_some_and(|value| (low..=high).contains(&value))
            }
            SettingType::Number(_, low, high) => number(low, high),
            SettingType::Choice(_, of) => value.as_str().is_some_and(|value| of.contains(&value)),
            SettingType::Text(_) => value.is_string(),
            SettingType::Color(_) => color(value).is_some(),
        };
        (!fits).then(|| format!("{} is {value}; it can be {}", self.name, self.allowed()))
    }

    /// Returns the JSON Schema of its values.
    pub fn schema(&self) -> Value {
        let mut schema = match self.ty {
            SettingType::Toggle(_) => json!({ "type": "boolean" }),
            SettingType::Integer(_, low, high) => {
                json!({ "type": "integer", "minimum": low, "maximum": high })
            }
            SettingType::Number(_, low, high) => json!({ "type": "number", "minimum": low, "maximum": high }),
            SettingType::Choice(_, of) => json!({ "enum": of }),
            SettingType::Text(_) => json!({ "type": "string" }),
            SettingType::Color(_) => json!({
                "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 3, "maxItems": 3,
            }),
        };
        let unit = if self.unit.is_empty() { String::new() } else { format!(" ({})", self.unit) };
        schema["description"] = format!("{}{unit}", self.about).into();
        schema["default"] = self.default_value();
        schema
    }
}

fn color(value: &Value) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
    let color: [f64; 3] = numbers.try_into().ok()?;
    (value.as_array()?.len() == 3 && color.iter().all(|part| (0.0..=1e6).contains(part))).then_some(color)
}

/// The settings of one node, checked, with defaults where nothing was said.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    kind: &'static str,
    values: Vec<(&'static str, Value)>,
}

impl Settings {
    /// Takes values for the settings of a kind of node that were checked.
    pub(crate) fn new(kind: &'static str, values: Vec<(&'static str, Value)>) -> Self {
        Self { kind, values }
    }

    fn get<'s, T>(&'s self, name: &str, read: impl FnOnce(&'s Value) -> Option<T>) -> Result<T, Error> {
        let found = self.values.iter().find(|(known, _)| *known == name);
        found.and_then(|(_, value)| read(value)).ok_or_else(|| Error::NodeKind {
            kind: self.kind,
            reason: format!("it reads a setting `{name}` that it does not declare, or as another type"),
        })
    }

    /// Returns the value of an [`SettingType::Toggle`].
    ///
    /// # Errors
    /// If the kind describes no such setting; so of all of these.
    pub fn toggle(&self, name: &str) -> Result<bool, Error> {
        self.get(name, Value::as_bool)
    }

    /// Returns the value of an [`SettingType::Integer`].
    ///
    /// # Errors
    /// As [`toggle`](Self::toggle).
    pub fn integer(&self, name: &str) -> Result<i64, Error> {
        self.get(name, Value::as_i64)
    }

    /// Returns the value of an [`SettingType::Number`].
    ///
    /// # Errors
    /// As [`toggle`](Self::toggle).
    pub fn number(&self, name: &str) -> Result<f32, Error> {
        self.get(name, |value| value.as_f64().map(|value| value as f32))
    }

    /// Returns the value of an [`SettingType::Choice`] or an [`SettingType::Text`].
    ///
    /// # Errors
    /// As [`toggle`](Self::toggle).
    pub fn text(&self, name: &str) -> Result<&str, Error> {
        self.get(name, Value::as_str)
    }

    /// Returns the value of an [`SettingType::Color`].
    ///
    /// # Errors
    /// As [`toggle`](Self::toggle).
    pub fn color(&self, name: &str) -> Result<[f32; 3], Error> {
        self.get(name, |value| color(value).map(|color| color.map(|part| part as f32)))
    }
}
