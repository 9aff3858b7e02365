//! A file's text, and places in it.

use std::sync::Arc;

use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::Deserialize;

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
        let (line, column) = position(&self.source.text, self.offset);
        format!("{}:{line}:{column}", self.source.name)
    }

    pub(super) fn error(&self, problem: impl Into<String>) -> PipelineError {
        PipelineError { place: self.words(), problem: problem.into() }
    }
}

fn position(text: &str, offset: usize) -> (usize, usize) {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    (line, column)
}

/// Parses the text that begins at `offset` of a file; errors tell of the place in the file.
pub(super) fn parse<'t, T: Deserialize<'t>>(
    source: &Arc<Source>,
    text: &'t str,
    offset: usize,
) -> Result<T, PipelineError> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| {
        let begin = error.span.start;
        let inside = byte_of(text, begin.line, begin.col);
        Place { source: source.clone(), offset: offset + inside }.error(problem(&error.code))
    })
}

/// The parser's words, for people who write files and not Rust.
fn problem(error: &ron::Error) -> String {
    match error {
        ron::Error::NoSuchStructField { found, expected, .. } => {
            let near = crate::nodes::near_words(found, expected.iter().copied());
            format!("there is no field `{found}` here{near}")
        }
        ron::Error::MissingStructField { field, .. } => format!("the field `{field}` is missing here"),
        ron::Error::DuplicateStructField { field, .. } => format!("the field `{field}` stands here twice"),
        other => other.to_string().lines().collect::<Vec<_>>().join(" "),
    }
}

fn byte_of(text: &str, line: usize, column: usize) -> usize {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(start..).unwrap_or_default();
    start + rest.char_indices().nth(column.saturating_sub(1)).map_or(0, |(at, _)| at)
}

/// Where a raw part of the file begins. Raw values are slices of the text that they were read from.
pub(super) fn place_of(source: &Arc<Source>, raw: &RawValue) -> Place {
    let inner = raw.get_ron();
    let blank = inner.len() - inner.trim_start().len();
    let start = (inner.as_ptr() as usize).saturating_sub(source.text.as_ptr() as usize);
    Place { source: source.clone(), offset: start + blank }
}

/// Parses a raw part of the file.
pub(super) fn read<'t, T: Deserialize<'t>>(
    source: &Arc<Source>,
    raw: &'t RawValue,
) -> Result<Spot<T>, PipelineError> {
    let inner = raw.get_ron();
    let start = (inner.as_ptr() as usize).saturating_sub(source.text.as_ptr() as usize);
    Ok(Spot { value: parse(source, inner, start)?, place: place_of(source, raw) })
}
