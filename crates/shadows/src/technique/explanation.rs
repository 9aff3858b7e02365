//! What a technique says about a single point, for debugging.

use serde::Serialize;
use shadowgraph_shaders::ModuleSource;

/// How a technique explains the shadow of a light at a point.
#[derive(Clone, Debug)]
pub struct ShadowExplanation {
    /// The module `shadowgraph::explanation`, and those that it needs besides the technique's own of variant 0. It has the function
    /// `explain_shadow(light: u32, receiver: Receiver) -> array<f32, 32>`, and may call all functions of the technique.
    pub modules: Vec<ModuleSource>,
    /// Says what these numbers are; without shadows of the light, nothing.
    pub describe: fn(&ExplanationValues) -> Vec<ShadowFact>,
}

/// The numbers that `explain_shadow` returns.
pub type ExplanationValues = [f32; EXPLANATION_VALUES];

/// The length of the array that `explain_shadow` returns.
pub const EXPLANATION_VALUES: usize = 32;

/// A fact about the shadow of a light at a point, such as the cascade that it is read from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ShadowFact {
    /// What it is, in words for a line of text.
    pub name: &'static str,
    /// Its values: one, or those of each axis.
    pub values: Vec<f32>,
    /// The unit of the values; empty without one.
    pub unit: &'static str,
}

impl ShadowFact {
    /// Creates a fact.
    pub fn new<const N: usize>(name: &'static str, values: [f32; N], unit: &'static str) -> Self {
        Self { name, values: values.to_vec(), unit }
    }
}

impl std::fmt::Display for ShadowFact {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:", self.name)?;
        for &value in &self.values {
            // Depths differ in their last digits.
            match self.unit {
                "" => write!(f, " {value}")?,
                _ => write!(f, " {}", rounded(value))?,
            }
        }
        match self.unit {
            "" => Ok(()),
            unit => write!(f, " {unit}"),
        }
    }
}

/// Writes four significant digits.
fn rounded(value: f32) -> String {
    let magnitude = if value == 0.0 { 0.0 } else { value.abs().log10().floor() };
    let text = format!("{value:.*}", (3.0 - magnitude).clamp(0.0, 9.0) as usize);
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn facts_are_lines_with_four_digits_and_the_unit() {
        let line = |values: [f32; 2], unit| ShadowFact::new("a fact", values, unit).to_string();
        assert_eq!(line([0.012_345, 2048.0], "m"), "a fact: 0.01235 2048 m");
        assert_eq!(line([-1.5, 0.0], "texels"), "a fact: -1.5 0 texels");
        assert_eq!(line([0.217_297_85, 3.0], ""), "a fact: 0.21729785 3");
        assert_eq!(line([f32::NAN, 123_456.0], "m"), "a fact: NaN 123456 m");
    }
}
