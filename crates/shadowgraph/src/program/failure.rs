//! How a command ends when it does not end well.

/// One line for the user and the exit code.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    /// The exit code, one of the constants.
    pub(crate) code: u8,
    /// What is wrong and where.
    pub(crate) message: String,
}

impl Failure {
    /// The input or a setting is wrong.
    pub(crate) const INPUT: u8 = 1;
    /// The command line is not one.
    pub(crate) const USAGE: u8 = 2;
    /// There is nothing to draw with.
    pub(crate) const NO_ADAPTER: u8 = 3;

    /// No device could be opened.
    pub(crate) fn no_device(error: crate::Error) -> Self {
        Self { code: Self::NO_ADAPTER, message: error.to_string() }
    }
}

/// What comes from the input, a setting or the output.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self { code: Self::INPUT, message: error.to_string() }
    }
}
