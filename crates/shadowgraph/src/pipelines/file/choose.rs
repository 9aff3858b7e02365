//! Parameters, tiers and conditions: what of a document is there.

use std::fmt;

use serde_json::Value;

use super::document::{Condition, Document, Pairs};
use super::source::{PipelineError, Spot};
use crate::nodes::near_words;

/// What whoever draws chooses of a pipeline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Choices {
    /// Values of parameters, by name.
    pub parameters: Vec<(String, Value)>,
    /// A tier of quality by name; `None`: that which the file has for the device, if it has one.
    pub tier: Option<String>,
    /// The kind of device: `cpu`, `integrated`, `discrete`, `virtual` or `other`; `None` where it is not known.
    pub device: Option<&'static str>,
}

/// As they stand on the command line, in brackets behind something else; nothing for none.
impl fmt::Display for Choices {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let set = self.parameters.iter().map(|(name, value)| format!("--set {name}={value}"));
        let words: Vec<_> = set.chain(self.tier.iter().map(|tier| format!("--tier {tier}"))).collect();
        if words.is_empty() { Ok(()) } else { write!(f, " (with {})", words.join(" ")) }
    }
}

/// Kinds of devices that a file can have a tier for.
const DEVICES: &[&str] = &["cpu", "integrated", "discrete", "virtual", "other"];

/// The parameters of a document with the values that were chosen.
pub(super) struct Chosen<'d>(Vec<(&'d str, &'d Value)>);

impl Document {
    /// Says what is wrong with parameters and tiers, whatever is chosen.
    pub(super) fn check_parameters(&self) -> Result<(), PipelineError> {
        for (tier, values) in &self.tiers {
            for (name, value) in values {
                let place = self.parameter(name)?;
                same_type(place, value).map_or(Ok(()), |problem| {
                    Err(value.error(format!("tier `{}`: {problem}", tier.value)))
                })?;
            }
        }
        for (device, tier) in &self.tier_for {
            if !DEVICES.contains(&device.value.as_str()) {
                let near = near_words(&device.value, DEVICES.iter().copied());
                return Err(device.error(format!("there is no kind of device `{}`{near}", device.value)));
            }
            self.tier(&tier.value).map_err(|problem| tier.error(problem))?;
        }
        for entry in &self.nodes {
            if let Some(when) = &entry.when {
                self.check_condition(when, &when.value)?;
            }
            for (setting, value) in &entry.settings {
                if let Some(name) = parameter_of(&value.value) {
                    self.parameter(&Spot { value: name.to_owned(), place: value.place.clone() }).map_err(
                        |error| PipelineError {
                            problem: format!("setting `{}`: {}", setting.value, error.problem),
                            ..error
                        },
                    )?;
                }
            }
        }
        Ok(())
    }

    fn check_condition(&self, when: &Spot<Condition>, condition: &Condition) -> Result<(), PipelineError> {
        let named = |name: &String| self.parameter(&Spot { value: name.clone(), place: when.place.clone() });
        match condition {
            Condition::On(name) if named(name)?.value.is_boolean() => Ok(()),
            Condition::On(name) => {
                Err(when
                    .error(format!("`{name}` is not true or false: ask for its value, Is(\"{name}\", ...)")))
            }
            Condition::Is(name, value) => {
                let wrong =
                    same_type(named(name)?, &Spot { value: value.clone(), place: when.place.clone() });
                wrong.map_or(Ok(()), |problem| Err(when.error(problem)))
            }
            Condition::Not(inner) => self.check_condition(when, inner),
            Condition::All(list) | Condition::Any(list) => {
                list.iter().try_for_each(|inner| self.check_condition(when, inner))
            }
        }
    }

    fn parameter(&self, name: &Spot<String>) -> Result<&Spot<Value>, PipelineError> {
        let found = self.parameters.iter().find(|(known, _)| known.value == name.value);
        found.map(|(_, value)| value).ok_or_else(|| name.error(self.no_parameter(&name.value)))
    }

    fn no_parameter(&self, name: &str) -> String {
        none_such("parameter", name, &self.parameters)
    }

    fn tier(&self, name: &str) -> Result<&Pairs<Value>, String> {
        let found = self.tiers.iter().find(|(known, _)| known.value == name);
        found.map(|(_, values)| values).ok_or_else(|| none_such("tier", name, &self.tiers))
    }

    /// Returns every choice of a tier, and none: what a file is checked for.
    pub(super) fn all_choices(&self) -> Vec<Choices> {
        let tier = |tier: Option<&str>| Choices { tier: tier.map(str::to_owned), ..Choices::default() };
        std::iter::once(tier(None))
            .chain(self.tiers.iter().map(|(name, _)| tier(Some(&name.value))))
            .collect()
    }

    /// Takes the default of each parameter, then the tier's value, then that which was chosen.
    pub(super) fn choose<'d>(
        &'d self,
        name: &str,
        choices: &'d Choices,
    ) -> Result<Chosen<'d>, PipelineError> {
        let refused = |problem: String| PipelineError { place: name.to_owned(), problem };
        let mut chosen: Vec<(&str, &Value)> =
            self.parameters.iter().map(|(name, value)| (&*name.value, &value.value)).collect();
        let of_device = choices.device.and_then(|device| {
            self.tier_for.iter().find(|(known, _)| known.value == device).map(|(_, tier)| tier.value.as_str())
        });
        if let Some(tier) = choices.tier.as_deref().or(of_device) {
            for (name, value) in self.tier(tier).map_err(refused)? {
                set(&mut chosen, &name.value, &value.value);
            }
        }
        for (parameter, value) in &choices.parameters {
            let Some((_, default)) = self.parameters.iter().find(|(known, _)| known.value == *parameter)
            else {
                return Err(refused(self.no_parameter(parameter)));
            };
            let spot = Spot { value: value.clone(), place: default.place.clone() };
            same_type(default, &spot)
                .map_or(Ok(()), |problem| Err(refused(format!("parameter `{parameter}`: {problem}"))))?;
            set(&mut chosen, parameter, value);
        }
        Ok(Chosen(chosen))
    }
}

fn none_such<T>(what: &str, name: &str, known: &[(Spot<String>, T)]) -> String {
    let near = match known {
        [] => ": the pipeline has none".to_owned(),
        known => near_words(name, known.iter().map(|(known, _)| &*known.value)),
    };
    format!("there is no {what} `{name}`{near}")
}

fn set<'d>(chosen: &mut [(&'d str, &'d Value)], name: &str, value: &'d Value) {
    if let Some((_, place)) = chosen.iter_mut().find(|(known, _)| *known == name) {
        *place = value;
    }
}

/// The parameter that a setting's value stands for: `"$name"`.
pub(super) fn parameter_of(value: &Value) -> Option<&str> {
    value.as_str()?.strip_prefix('$')
}

/// Says what is wrong where values are not of one type.
fn same_type(default: &Spot<Value>, value: &Spot<Value>) -> Option<String> {
    let (was, is) = (type_of(&default.value), type_of(&value.value));
    (was != is).then(|| format!("{} is {is}, and the parameter is {was}", value.value))
}

fn type_of(value: &Value) -> &'static str {
    match value {
        Value::Bool(_) => "true or false",
        Value::Number(_) => "a number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) | Value::Null => "something else",
    }
}

impl Chosen<'_> {
    fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| *known == name).map(|(_, value)| *value)
    }

    /// Whether a condition holds.
    pub(super) fn holds(&self, condition: &Condition) -> bool {
        match condition {
            Condition::On(name) => self.get(name) == Some(&Value::Bool(true)),
            Condition::Is(name, value) => match (self.get(name), value) {
                (Some(Value::Number(a)), Value::Number(b)) => a.as_f64() == b.as_f64(),
                (own, value) => own == Some(value),
            },
            Condition::Not(inner) => !self.holds(inner),
            Condition::All(list) => list.iter().all(|inner| self.holds(inner)),
            Condition::Any(list) => list.iter().any(|inner| self.holds(inner)),
        }
    }

    /// The value, or that of the parameter that it stands for.
    pub(super) fn value<'v>(&'v self, value: &'v Value) -> &'v Value {
        parameter_of(value).and_then(|name| self.get(name)).unwrap_or(value)
    }
}
