//! Settings of nodes.

use serde_json::Value;
pub use shadowgraph_shadows::{Setting, SettingType};

use crate::error::Error;

/// Values of a node's settings, checked, with defaults for those that are not given.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    kind: &'static str,
    values: Vec<(&'static str, Value)>,
    scalars: Vec<u8>,
}

impl Settings {
    /// Creates settings from checked values.
    pub(crate) fn new(kind: &'static str, values: Vec<(&'static Setting, Value)>) -> Self {
        let scalars = values.iter().filter_map(|(setting, value)| scalar(setting, value)).flatten().collect();
        let values = values.into_iter().map(|(setting, value)| (setting.name, value)).collect();
        Self { kind, values, scalars }
    }

    fn get<'s, T>(&'s self, name: &str, read: impl FnOnce(&'s Value) -> Option<T>) -> Result<T, Error> {
        let found = self.values.iter().find(|(known, _)| *known == name);
        found.and_then(|(_, value)| read(value)).ok_or_else(|| Error::NodeKind {
            kind: self.kind,
            reason: format!("it reads a setting `{name}` that it does not declare, or as another type"),
        })
    }

    /// Returns all integers, numbers and toggles in the order of their declaration, four bytes each: a struct of `i32`, `u32` and `f32`
    /// in WGSL, where a toggle is a `u32`, 0 or 1.
    pub fn scalars(&self) -> &[u8] {
        &self.scalars
    }

    /// Returns the value of an [`SettingType::Toggle`].
    ///
    /// # Errors
    /// If the kind declares no setting of this name and type.
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
        self.get(name, |value| shadowgraph_shadows::color(value).map(|color| color.map(|part| part as f32)))
    }
}

/// Returns the bytes of a number or a toggle.
fn scalar(setting: &Setting, value: &Value) -> Option<[u8; 4]> {
    match setting.ty {
        SettingType::Toggle(_) => Some(u32::from(value.as_bool()?).to_ne_bytes()),
        SettingType::Integer(..) | SettingType::PowerOfTwo(..) => {
            Some((value.as_i64()? as u32).to_ne_bytes())
        }
        SettingType::Number(..) => Some((value.as_f64()? as f32).to_ne_bytes()),
        _ => None,
    }
}
