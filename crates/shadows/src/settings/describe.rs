//! Descriptions of settings, and everything that is derived from them but validation.
//!
//! A setting is declared once: structs and enums by [`declare_settings!`](crate::declare_settings), settings of nodes as
//! constants. The declaration is a static tree of [`Setting`]s. Validation, the text of errors, the command `nodes`, the tables of
//! the documents, JSON schemas and the controls of the window all read that tree, so none of them repeats a range.
//!
//! It is here and not in `core`, which is a render graph and has no settings, and not in `shadowgraph`, which is above the
//! techniques.

use serde_json::{Map, Value, json};

use crate::error::Error;

/// One setting: its name, what it may be, its default, its unit, and what it does.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// The name in files.
    pub name: &'static str,
    /// The values that are allowed, and the default.
    pub ty: SettingType,
    /// The unit of the value; empty for none.
    pub unit: &'static str,
    /// A condition that the type does not state; empty for none.
    pub note: &'static str,
    /// Description of the setting.
    pub about: &'static str,
}

/// The values that a setting may have. Each kind begins with the default.
#[derive(Clone, Copy, Debug)]
pub enum SettingType {
    /// True or false.
    Toggle(bool),
    /// An integer from the second to the third.
    Integer(i64, i64, i64),
    /// A power of two from the second to the third.
    PowerOfTwo(i64, i64, i64),
    /// A number from the second to the third.
    Number(f64, f64, f64),
    /// One of these strings.
    Choice(&'static str, &'static [&'static str]),
    /// Any string.
    Text(&'static str),
    /// Red, green and blue, linear, each 0 to 1,000,000.
    Color([f64; 3]),
    /// A value of an enum.
    Enum(fn() -> Value, &'static [Variant]),
    /// A struct, whose fields have their own defaults.
    Struct(&'static [Setting]),
    /// A list of values.
    List(fn() -> Value, &'static SettingType),
    /// A value or none; none by default.
    Optional(&'static SettingType),
    /// A value that these words describe. Without a default it is required.
    Other(Option<fn() -> Value>, &'static str),
}

/// One variant of an enum.
#[derive(Clone, Copy, Debug)]
pub struct Variant {
    /// The name in files.
    pub name: &'static str,
    /// Its meaning.
    pub about: &'static str,
    /// The values that it carries.
    pub payload: Payload,
}

/// The values that a variant carries. Their defaults are examples.
#[derive(Clone, Copy, Debug)]
pub enum Payload {
    /// None.
    Empty,
    /// One value without a name.
    Value(&'static Setting),
    /// Values with names.
    Fields(&'static [Setting]),
}

impl Setting {
    /// Describes a setting without a unit.
    pub const fn new(name: &'static str, ty: SettingType, about: &'static str) -> Self {
        Self { name, ty, unit: "", note: "", about }
    }

    /// Adds the unit of the value.
    #[must_use]
    pub const fn in_units(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }

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

    /// Returns the default; null for a value that is optional or required.
    pub fn default_value(&self) -> Value {
        self.ty.default_value()
    }

    /// Returns the default as a RON file has it.
    pub fn default_ron(&self) -> String {
        self.ty.ron(&self.default_value())
    }

    /// Returns one line about the setting: default, allowed values and what it does.
    pub fn describe(&self) -> String {
        let default = match self.ty {
            SettingType::Other(None, _) => "required".to_owned(),
            _ => self.default_ron(),
        };
        format!("{default}; {}: {}", self.allowed(), self.about)
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

    /// Returns the JSON Schema of the values.
    pub fn schema(&self) -> Value {
        let mut schema = self.ty.schema();
        let conditions = [(" (", self.unit, ")"), (", ", self.note, "")];
        let conditions = conditions.into_iter().filter(|(_, words, _)| !words.is_empty());
        let conditions: String =
            conditions.map(|(open, words, close)| [open, words, close].concat()).collect();
        schema["description"] = format!("{}{conditions}", self.about.trim_end_matches('.')).into();
        if !matches!(self.ty, SettingType::Other(None, _)) {
            schema["default"] = self.default_value();
        }
        schema
    }
}

impl SettingType {
    /// Returns the type with another default, for values that have one of several kinds.
    #[must_use]
    pub const fn with_default(self, default: fn() -> Value) -> Self {
        match self {
            Self::Enum(_, variants) => Self::Enum(default, variants),
            Self::List(_, item) => Self::List(default, item),
            Self::Other(_, words) => Self::Other(Some(default), words),
            other => other,
        }
    }

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

    /// Returns the default; null for a value that is optional or required.
    pub fn default_value(&self) -> Value {
        match self {
            Self::Toggle(value) => (*value).into(),
            Self::Integer(value, ..) | Self::PowerOfTwo(value, ..) => (*value).into(),
            Self::Number(value, ..) => (*value).into(),
            Self::Choice(value, _) | Self::Text(value) => (*value).into(),
            Self::Color(value) => json!(value),
            Self::Enum(value, _) | Self::List(value, _) => value(),
            Self::Struct(fields) => defaults(fields),
            Self::Optional(_) | Self::Other(None, _) => Value::Null,
            Self::Other(Some(value), _) => value(),
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

    /// Returns the JSON Schema of the values.
    fn schema(&self) -> Value {
        match self {
            Self::Toggle(_) => json!({ "type": "boolean" }),
            Self::Integer(_, low, high) => json!({ "type": "integer", "minimum": low, "maximum": high }),
            Self::PowerOfTwo(_, low, high) => json!({ "enum": powers(*low, *high).collect::<Vec<_>>() }),
            Self::Number(_, low, high) => json!({ "type": "number", "minimum": low, "maximum": high }),
            Self::Choice(_, names) => json!({ "enum": names }),
            Self::Text(_) => json!({ "type": "string" }),
            Self::Color(_) => json!({
                "type": "array", "items": { "type": "number", "minimum": 0 }, "minItems": 3, "maxItems": 3,
            }),
            Self::Enum(_, variants) => {
                json!({ "anyOf": variants.iter().map(Variant::schema).collect::<Vec<_>>() })
            }
            Self::Struct(fields) => fields_schema(fields),
            Self::List(_, item) => json!({ "type": "array", "items": item.schema() }),
            Self::Optional(inner) => json!({ "anyOf": [{ "type": "null" }, inner.schema()] }),
            Self::Other(..) => json!({}),
        }
    }

    /// Returns a value of this type as a RON file has it.
    pub fn ron(&self, value: &Value) -> String {
        match (self, value) {
            (Self::Number(..), Value::Number(number)) => float(number.as_f64().unwrap_or_default()),
            (Self::Color(_), Value::Array(_)) => match color(value) {
                Some(color) => format!("({})", color.map(float).join(", ")),
                None => value.to_string(),
            },
            (Self::Enum(_, variants), _) => {
                let found = variants.iter().find_map(|variant| variant.ron(value));
                found.unwrap_or_else(|| value.to_string())
            }
            (Self::Struct(fields), Value::Object(_)) => format!("({})", fields_ron(fields, value)),
            (Self::List(_, item), Value::Array(items)) => {
                format!("[{}]", items.iter().map(|value| item.ron(value)).collect::<Vec<_>>().join(", "))
            }
            (Self::Optional(_), Value::Null) => "None".into(),
            (Self::Optional(inner), _) => format!("Some({})", inner.ron(value)),
            _ => value.to_string(),
        }
    }
}

impl Variant {
    /// Returns an example of the variant as JSON.
    pub fn example(&self) -> Value {
        match self.payload {
            Payload::Empty => self.name.into(),
            Payload::Value(setting) => json!({ self.name: setting.default_value() }),
            Payload::Fields(fields) => json!({ self.name: defaults(fields) }),
        }
    }

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

    fn schema(&self) -> Value {
        let mut schema = match self.payload {
            Payload::Empty => json!({ "const": self.name }),
            Payload::Value(setting) => {
                object(Map::from_iter([(self.name.to_owned(), setting.schema())]), &[self.name])
            }
            Payload::Fields(fields) => {
                let names: Vec<&str> = fields.iter().map(|setting| setting.name).collect();
                let mut inner = fields_schema(fields);
                inner["required"] = json!(names);
                object(Map::from_iter([(self.name.to_owned(), inner)]), &[self.name])
            }
        };
        schema["description"] = self.about.into();
        schema
    }

    fn ron(&self, value: &Value) -> Option<String> {
        match self.payload {
            Payload::Empty => (value.as_str()? == self.name).then(|| self.name.into()),
            Payload::Value(setting) => {
                value.get(self.name).map(|value| format!("{}({})", self.name, setting.ty.ron(value)))
            }
            Payload::Fields(fields) => {
                value.get(self.name).map(|value| format!("{}({})", self.name, fields_ron(fields, value)))
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

/// Returns the defaults of these settings as a JSON object. Required values are left out.
pub fn defaults(settings: &[Setting]) -> Value {
    let given = settings.iter().filter(|setting| !matches!(setting.ty, SettingType::Other(None, _)));
    Value::Object(given.map(|setting| (setting.name.to_owned(), setting.default_value())).collect())
}

/// Returns the JSON Schema of an object with these fields, none of which is required unless it has no default.
pub(crate) fn fields_schema(settings: &[Setting]) -> Value {
    let required = settings.iter().filter(|setting| matches!(setting.ty, SettingType::Other(None, _)));
    let required: Vec<&str> = required.map(|setting| setting.name).collect();
    object(settings.iter().map(|setting| (setting.name.to_owned(), setting.schema())).collect(), &required)
}

fn object(properties: Map<String, Value>, required: &[&str]) -> Value {
    json!({
        "type": "object", "properties": properties, "required": required, "additionalProperties": false,
    })
}

fn allow(fields: &[Setting], value: &Value) -> bool {
    fields.iter().all(|setting| value.get(setting.name).is_none_or(|value| setting.ty.allows(value)))
}

fn fields_ron(fields: &[Setting], value: &Value) -> String {
    let field = |setting: &Setting| {
        let value = value.get(setting.name)?;
        Some(format!("{}: {}", setting.name, setting.ty.ron(value)))
    };
    fields.iter().filter_map(field).collect::<Vec<_>>().join(", ")
}

/// Reads a colour: three numbers from 0 to 1,000,000.
pub fn color(value: &Value) -> Option<[f64; 3]> {
    let numbers: Option<Vec<f64>> = value.as_array()?.iter().map(Value::as_f64).collect();
    let color: [f64; 3] = numbers?.try_into().ok()?;
    color.iter().all(|part| (0.0..=1e6).contains(part)).then_some(color)
}

fn powers(low: i64, high: i64) -> impl Iterator<Item = i64> {
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

/// Returns a number that RON reads as a float: without an exponent, with a point.
fn float(number: f64) -> String {
    let text = number.to_string();
    if text.contains('.') || !number.is_finite() { text } else { text + ".0" }
}
