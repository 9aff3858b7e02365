//! The choice of a GPU.

use super::error::OptionError;
use std::str::FromStr;

/// The GPU to use.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum AdapterChoice {
    /// The best one; a software adapter if there is no other.
    #[default]
    Auto,
    /// A software adapter.
    Cpu,
    /// The one whose name contains this text, ignoring case.
    Name(String),
}

impl AdapterChoice {
    /// Returns whether the choice is a name that an adapter's name contains.
    ///
    /// ```
    /// use shadowgraph::options::AdapterChoice;
    /// assert!(AdapterChoice::Name("radeon".to_owned()).matches_name("AMD Radeon Graphics"));
    /// ```
    #[must_use]
    pub fn matches_name(&self, adapter_name: &str) -> bool {
        matches!(self, Self::Name(wanted) if adapter_name.to_lowercase().contains(&wanted.to_lowercase()))
    }
}

impl FromStr for AdapterChoice {
    type Err = OptionError;

    fn from_str(text: &str) -> Result<Self, OptionError> {
        match text.trim() {
            "" => Err(OptionError::new(
                "adapter",
                "empty value; expected auto, cpu or a part of an adapter's name",
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
    fn auto_and_cpu_are_keywords_and_the_rest_is_a_name() {
        assert_eq!("auto".parse(), Ok(AdapterChoice::Auto));
        assert_eq!("cpu".parse(), Ok(AdapterChoice::Cpu));
        assert_eq!("llvmpipe".parse(), Ok(AdapterChoice::Name("llvmpipe".to_owned())));
        assert!(" ".parse::<AdapterChoice>().is_err());
    }

    #[test]
    fn only_a_name_matches_a_name() {
        assert!(!AdapterChoice::Auto.matches_name("auto"));
        assert!(!AdapterChoice::Name("intel".to_owned()).matches_name("AMD Radeon"));
    }
}
