//! JSON Schemas of settings.

use serde_json::{Map, Value, json};

use super::allowed::powers;
use super::{Payload, Setting, SettingType, Variant};

impl Setting {
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
}

impl Variant {
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
