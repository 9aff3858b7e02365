//! Parameters of pipeline files and the conditions on them.

use std::fmt;

use serde_json::Value;
use shadowgraph_core::did_you_mean;

use super::document::{Condition, Document, NodeEntry};
use super::source::Location;
use crate::error::PipelineError;

/// Values for the parameters of a pipeline file, by name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameters(pub Vec<(String, Value)>);

/// Writes `name=value` for each parameter, in parentheses; nothing if there is none.
impl fmt::Display for Parameters {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values: Vec<_> = self.0.iter().map(|(name, value)| format!("{name}={value}")).collect();
        if values.is_empty() { Ok(()) } else { write!(f, " (with {})", values.join(" ")) }
    }
}

/// The parameters of a document with their defaults or the values that were set.
pub(super) struct ParameterValues<'d>(Vec<(&'d str, &'d Value)>);

impl Document {
    /// Checks that settings and conditions refer to parameters of the right type.
    pub(super) fn check_parameters(&self) -> Result<(), PipelineError> {
        self.nodes.iter().try_for_each(|entry| self.check_entry(entry))
    }

    fn check_entry(&self, entry: &NodeEntry) -> Result<(), PipelineError> {
        if let Some(when) = &entry.when {
            self.check_condition(&when.location, &when.value)?;
        }
        for (setting, value) in &entry.settings {
            if let Some(name) = referenced_parameter(&value.value) {
                self.parameter(name)
                    .map_err(|problem| value.error(format!("setting `{}`: {problem}", setting.value)))?;
            }
        }
        Ok(())
    }

    fn check_condition(&self, location: &Location, condition: &Condition) -> Result<(), PipelineError> {
        match condition {
            Condition::On(name) => match self.parameter(name).map_err(|problem| location.error(problem))? {
                Value::Bool(_) => Ok(()),
                value => {
                    let ty = type_name(value);
                    Err(location
                        .error(format!("On(\"{name}\") expects a boolean parameter, and it is a {ty}")))
                }
            },
            Condition::Not(inner) => self.check_condition(location, inner),
        }
    }

    /// Returns the default of a parameter.
    fn parameter(&self, name: &str) -> Result<&Value, String> {
        let found = self.parameters.iter().find(|(known, _)| known.value == name);
        found.map(|(_, value)| &value.value).ok_or_else(|| self.unknown_parameter(name))
    }

    fn unknown_parameter(&self, name: &str) -> String {
        let hint = match &self.parameters[..] {
            [] => "; the pipeline has no parameters".to_owned(),
            known => did_you_mean(name, known.iter().map(|(known, _)| &*known.value)),
        };
        format!("unknown parameter `{name}`{hint}")
    }

    /// Returns the default of each parameter, or the value that was set.
    pub(super) fn parameter_values<'d>(
        &'d self,
        name: &str,
        set: &'d Parameters,
    ) -> Result<ParameterValues<'d>, PipelineError> {
        let error = |problem: String| PipelineError { location: name.to_owned(), problem };
        let mut values: Vec<(&str, &Value)> =
            self.parameters.iter().map(|(name, value)| (&*name.value, &value.value)).collect();
        for (parameter, value) in &set.0 {
            let Some((_, current)) = values.iter_mut().find(|(known, _)| known == parameter) else {
                return Err(error(self.unknown_parameter(parameter)));
            };
            let (expected, given) = (type_name(current), type_name(value));
            if expected != given {
                let problem =
                    format!("parameter `{parameter}`: expected a {expected}, found {value}, a {given}");
                return Err(error(problem));
            }
            *current = value;
        }
        Ok(ParameterValues(values))
    }
}

/// Returns the parameter that a setting refers to: `"$name"`.
pub(super) fn referenced_parameter(value: &Value) -> Option<&str> {
    value.as_str()?.strip_prefix('$')
}

fn type_name(value: &Value) -> &'static str {
    match value {
        Value::Bool(_) => "boolean",
        Value::Number(_) => "number",
        Value::String(_) => "string",
        Value::Array(_) => "list",
        Value::Object(_) | Value::Null => "map",
    }
}

impl ParameterValues<'_> {
    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    /// Returns whether a condition holds.
    pub(super) fn holds(&self, condition: &Condition) -> bool {
        match condition {
            Condition::On(name) => self.get(name) == Some(&Value::Bool(true)),
            Condition::Not(inner) => !self.holds(inner),
        }
    }

    /// Returns the value, or that of the parameter that it refers to.
    pub(super) fn resolve<'v>(&'v self, value: &'v Value) -> &'v Value {
        referenced_parameter(value).and_then(|name| self.get(name)).unwrap_or(value)
    }
}
