//! Errors of inspecting.

/// An error in a name or a dump that was passed in.
///
/// Each has a [`code`](Self::code) that never changes and begins the message; `docs/errors.md` has a section with
/// an example for each code.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the fields are named as in the message above them")]
pub enum Error {
    /// An unknown pass or resource name.
    #[error("SG0701: unknown pass or resource `{name}`{hint}")]
    UnknownName { name: String, hint: String },
    /// A string that is not a dump of a plan, or a dump of another schema version.
    #[error("SG0702: not a valid dump: {problem}")]
    Dump { problem: String },
    /// An address on which no page can be served.
    #[error(
        "SG0703: no page can be served on {address}: {problem}; choose another port, or 0 for any free one"
    )]
    Serve { address: std::net::SocketAddr, problem: String },
}

impl Error {
    /// Returns the error's code, such as `SG0701`. A code is never reused for another error.
    pub fn code(&self) -> &'static str {
        match self {
            Self::UnknownName { .. } => "SG0701",
            Self::Dump { .. } => "SG0702",
            Self::Serve { .. } => "SG0703",
        }
    }
}
