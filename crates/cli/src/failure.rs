//! Errors of commands.

use shadowgraph::Error;
use shadowgraph::options::OptionError;
use shadowgraph_quality::Error as QualityError;

/// An error message of one line and the exit code.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// Exit code, one of the constants.
    pub(crate) code: u8,
    /// Problem and location.
    pub(crate) message: String,
}

impl Failure {
    /// The input or a setting is invalid.
    pub(crate) const INPUT: u8 = 1;
    /// The command line is invalid.
    pub(crate) const USAGE: u8 = 2;
    /// There is no usable adapter or display.
    pub(crate) const NO_ADAPTER: u8 = 3;

    /// Creates the failure of a device that cannot be opened.
    pub(crate) fn no_device(error: shadowgraph::Error) -> Self {
        Self { code: Self::NO_ADAPTER, message: error.to_string() }
    }
}

/// Converts errors of the input, a setting or the output. If an option is the cause, the message begins with its name.
impl<E: std::error::Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        let any: &(dyn std::error::Error + 'static) = &error;
        let message = if let Some(OptionError { option, reason }) = any.downcast_ref() {
            format!("--{}: {reason}", option.replace('_', "-"))
        } else if let Some(option) = option_of(any) {
            format!("--{option}: {error}")
        } else {
            error.to_string()
        };
        Self { code: Self::INPUT, message }
    }
}

/// Returns the option whose value causes a library error.
fn option_of(error: &(dyn std::error::Error + 'static)) -> Option<&'static str> {
    let error = match error.downcast_ref() {
        Some(QualityError::BenchAov) => return Some("aov"),
        Some(QualityError::Draw(error)) => error,
        _ => error.downcast_ref::<Error>()?,
    };
    match error {
        Error::SampleCount { .. } | Error::SingleSampleOnly { .. } => Some("samples"),
        Error::Lighting(shadowgraph::lighting::Error::Samples { .. }) => Some("samples"),
        Error::ImageSize { .. } => Some("size"),
        Error::UnknownLight { .. }
        | Error::UnknownTexture { .. }
        | Error::NotDisplayable { .. }
        | Error::MissingOutput { .. } => Some("aov"),
        _ => None,
    }
}
