//! The text of a file, and locations in it.

use std::sync::Arc;

use ron::value::RawValue;
use serde::Deserialize;

use crate::error::PipelineError;
use crate::ron_file;

/// The text of a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct SourceText {
    /// The name in messages.
    pub(super) name: String,
    pub(super) text: String,
}

/// A location in a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Location {
    source: Arc<SourceText>,
    /// The offset from the start of the file, bytes.
    offset: usize,
}

/// A value with its location.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spanned<T> {
    pub(super) value: T,
    pub(super) location: Location,
}

impl<T> Spanned<T> {
    pub(super) fn error(&self, problem: impl Into<String>) -> PipelineError {
        self.location.error(problem)
    }
}

impl Location {
    /// Returns `file:line:column`, from 1.
    pub(super) fn describe(&self) -> String {
        ron_file::location(&self.source.name, &self.source.text, self.offset)
    }

    pub(super) fn error(&self, problem: impl Into<String>) -> PipelineError {
        PipelineError { location: self.describe(), problem: ron_file::one_line(&problem.into()) }
    }
}

/// Parses text that starts at `offset` of a file; errors have the location in the file.
pub(super) fn parse<'t, T: Deserialize<'t>>(
    source: &Arc<SourceText>,
    text: &'t str,
    offset: usize,
) -> Result<T, PipelineError> {
    let location = |inside| Location { source: source.clone(), offset: offset + inside };
    ron_file::parse_text(text).map_err(|(inside, problem)| location(inside).error(problem))
}

/// Parses a raw value of the file.
pub(super) fn parse_raw<'t, T: Deserialize<'t>>(
    source: &Arc<SourceText>,
    raw: &'t RawValue,
) -> Result<Spanned<T>, PipelineError> {
    let value = parse(source, raw.get_ron(), ron_file::start_of(&source.text, raw))?;
    let offset = ron_file::offset_of(&source.text, raw);
    Ok(Spanned { value, location: Location { source: source.clone(), offset } })
}
