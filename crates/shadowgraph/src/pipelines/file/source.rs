//! A file's text, and places in it.

use std::sync::Arc;

use ron::value::RawValue;
use serde::Deserialize;

use crate::ron_file;

/// What is wrong with a pipeline, where, and the way out: one line.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct PipelineError {
    /// The file, with line and column where it is one place in it.
    pub place: String,
    /// What is wrong, and what would be right.
    pub problem: String,
}

/// A file as it was read.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Source {
    /// What messages call it.
    pub(super) name: String,
    pub(super) text: String,
}

/// A place in a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Place {
    source: Arc<Source>,
    /// Bytes from its begin.
    offset: usize,
}

/// Something that stands somewhere.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Spot<T> {
    pub(super) value: T,
    pub(super) place: Place,
}

impl<T> Spot<T> {
    pub(super) fn error(&self, problem: impl Into<String>) -> PipelineError {
        self.place.error(problem)
    }
}

impl Place {
    /// The place in words: file, line, column, from 1.
    pub(super) fn words(&self) -> String {
        ron_file::place(&self.source.name, &self.source.text, self.offset)
    }

    pub(super) fn error(&self, problem: impl Into<String>) -> PipelineError {
        PipelineError { place: self.words(), problem: ron_file::one_line(&problem.into()) }
    }
}

/// Parses the text that begins at `offset` of a file; errors tell of the place in the file.
pub(super) fn parse<'t, T: Deserialize<'t>>(
    source: &Arc<Source>,
    text: &'t str,
    offset: usize,
) -> Result<T, PipelineError> {
    ron_file::read_at(text)
        .map_err(|(inside, problem)| Place { source: source.clone(), offset: offset + inside }.error(problem))
}

/// Where a raw part of the file begins.
pub(super) fn place_of(source: &Arc<Source>, raw: &RawValue) -> Place {
    Place { source: source.clone(), offset: ron_file::offset_of(&source.text, raw) }
}

/// Parses a raw part of the file.
pub(super) fn read<'t, T: Deserialize<'t>>(
    source: &Arc<Source>,
    raw: &'t RawValue,
) -> Result<Spot<T>, PipelineError> {
    let start = ron_file::start_of(&source.text, raw);
    Ok(Spot { value: parse(source, raw.get_ron(), start)?, place: place_of(source, raw) })
}
