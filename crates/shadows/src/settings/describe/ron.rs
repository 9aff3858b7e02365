//! Values of settings as RON files have them.

use serde_json::Value;

use super::allowed::color;
use super::{Payload, Setting, SettingType, Variant};

impl Setting {
    /// Returns the default as a RON file has it.
    pub fn default_ron(&self) -> String {
        self.ty.ron(&self.default_value())
    }
}

impl SettingType {
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

fn fields_ron(fields: &[Setting], value: &Value) -> String {
    let field = |setting: &Setting| {
        let value = value.get(setting.name)?;
        Some(format!("{}: {}", setting.name, setting.ty.ron(value)))
    };
    fields.iter().filter_map(field).collect::<Vec<_>>().join(", ")
}

/// Returns a number that RON reads as a float: without an exponent, with a point.
fn float(number: f64) -> String {
    let text = number.to_string();
    if text.contains('.') || !number.is_finite() { text } else { text + ".0" }
}
