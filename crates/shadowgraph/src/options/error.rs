//! What can be wrong with an option.

/// An option's value that is refused. The message is one line: the option, what is wrong, what is allowed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{option}: {reason}")]
pub struct OptionError {
    /// The option as it is written on the command line: `--camera`.
    pub option: &'static str,
    /// What is wrong and what is allowed.
    pub reason: String,
}

impl OptionError {
    /// Makes the error of an option.
    #[must_use]
    pub fn new(option: &'static str, reason: impl Into<String>) -> Self {
        Self { option, reason: reason.into() }
    }
}
