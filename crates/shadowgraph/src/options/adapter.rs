//! `--adapter`

use super::OptionError;
use std::str::FromStr;

/// Which GPU draws.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The best one there is; a software driver when there is no other.
    #[default]
    Auto,
    /// A software driver, and nothing else.
    Cpu,
    /// The one whose name contains this text, in any case of letters.
    Name(String),
}

impl AdapterChoice {
    /// Returns whether an adapter of this name is asked for. `cpu` is told by its kind, not by its name.
    ///
    /// ```
    /// use shadowgraph::options::AdapterChoice;
    /// assert!(AdapterChoice::Name("radeon".to_owned()).is_named("AMD Radeon Graphics"));
    /// ```
    #[must_use]
    pub fn is_named(&self, adapter_name: &str) -> bool {
        matches!(self, Self::Name(wanted) if adapter_name.to_lowercase().contains(&wanted.to_lowercase()))
    }
}

impl FromStr for AdapterChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text.trim() {
            "" => Err(OptionError::new(
                "--adapter",
                "it is empty; give auto, cpu or a part of an adapter's name",
            )),
            "auto" => Ok(Self::Auto),
            "cpu" => Ok(Self::Cpu),
            name => Ok(Self::Name(name.to_owned())),
        }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]
    use super::*;

    #[test]
    fn auto_and_cpu_are_words_and_the_rest_is_a_name() {
        assert_eq!("auto".parse(), Ok(AdapterChoice::Auto));
        assert_eq!("cpu".parse(), Ok(AdapterChoice::Cpu));
        assert_eq!("llvmpipe".parse(), Ok(AdapterChoice::Name("llvmpipe".to_owned())));
        assert!(" ".parse::<AdapterChoice>().is_err());
    }

    #[test]
    fn only_a_name_matches_a_name() {
        assert!(!AdapterChoice::Auto.is_named("auto"));
        assert!(!AdapterChoice::Name("intel".to_owned()).is_named("AMD Radeon"));
    }
}
