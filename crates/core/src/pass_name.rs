//! Passes in errors.

use std::fmt;
use std::panic::Location;

/// The place in the source that declared a pass.
pub(crate) type SourceLocation = &'static Location<'static>;

/// The places of all passes of a frame. Frames that differ only in them share a plan, so they are equal.
#[derive(Clone, Debug, Default)]
pub(crate) struct SourceLocations(pub(crate) Vec<SourceLocation>);

impl PartialEq for SourceLocations {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A pass in an error: its path, and the place in the source that declared it.
///
/// It is displayed as `` `lighting/forward` (src/main.rs:42:23) ``.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PassName {
    path: String,
    declared_at: Option<SourceLocation>,
}

impl PassName {
    pub(crate) fn new(path: String, declared_at: Option<SourceLocation>) -> Self {
        Self { path, declared_at }
    }

    /// Returns the pass's path: its name after those of its nodes, such as `lighting/forward`.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Returns the call that declared the pass, such as that of `render_pass`.
    pub fn declared_at(&self) -> Option<&'static Location<'static>> {
        self.declared_at
    }
}

impl From<&str> for PassName {
    fn from(path: &str) -> Self {
        Self::new(path.to_owned(), None)
    }
}

impl fmt::Display for PassName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}`", self.path)?;
        self.declared_at.map_or(Ok(()), |place| write!(f, " ({place})"))
    }
}
