//! Errors of options.

/// An invalid value of an option. The message is one line: the option, what is wrong, and what is expected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option}: {reason}")]
pub struct OptionError {
    /// The name of the option, such as `shadow_distance`.
    pub option: &'static str,
    /// The problem, and what is expected.
    pub reason: String,
}

impl OptionError {
    /// Creates the error of an option.
    #[must_use]
    pub fn new(option: &'static str, reason: impl Into<String>) -> Self {
        Self { option, reason: reason.into() }
    }
}
