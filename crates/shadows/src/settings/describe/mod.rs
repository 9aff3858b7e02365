//! Descriptions of settings, and everything that is derived from them but validation.
//!
//! A setting is declared once: structs and enums by [`declare_settings!`](crate::declare_settings), settings of nodes as
//! constants. The declaration is a static tree of [`Setting`]s. Validation, the text of errors, the command `nodes`, the tables of
//! the documents, JSON schemas and the controls of the window all read that tree, so none of them repeats a range.
//!
//! It is here and not in `core`, which is a render graph and has no settings, and not in `shadowgraph`, which is above the
//! techniques.

mod allowed;
mod ron;
mod schema;

pub use allowed::color;
pub(crate) use allowed::refused;
pub(crate) use schema::fields_schema;

use serde_json::{Value, json};

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

    /// Returns the default; null for a value that is optional or required.
    pub fn default_value(&self) -> Value {
        self.ty.default_value()
    }

    /// Returns one line about the setting: default, allowed values and what it does.
    pub fn describe(&self) -> String {
        let default = match self.ty {
            SettingType::Other(None, _) => "required".to_owned(),
            _ => self.default_ron(),
        };
        format!("{default}; {}: {}", self.allowed(), self.about)
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
}

/// Returns the defaults of these settings as a JSON object. Required values are left out.
pub fn defaults(settings: &[Setting]) -> Value {
    let given = settings.iter().filter(|setting| !matches!(setting.ty, SettingType::Other(None, _)));
    Value::Object(given.map(|setting| (setting.name.to_owned(), setting.default_value())).collect())
}
