//! Converts errors of naga_oil to a file, a line and a message.

use std::error::Error as _;

use naga_oil::compose::{Composer, ComposerError, ComposerErrorInner, ErrSource};

use crate::error::Error;
use crate::imports::Library;
use crate::source::ModuleSource;

/// naga_oil stores the index of the module in the upper bits of source offsets.
const OFFSET_BITS: u32 = 21;

/// Decorations that naga_oil adds to names, followed by the encoded import path and an `X`.
const NAME_DECORATIONS: [&str; 2] = ["X_naga_oil_mod_X", "X_naga_oil_vrt_X"];

/// Converts an error of composition.
pub(crate) fn wgsl_error(
    error: &ComposerError,
    composer: &Composer,
    library: &Library<'_>,
    entry: &ModuleSource,
) -> Error {
    let module = match &error.source {
        ErrSource::Module { name, .. } => library.get(name).filter(|_| composer.contains_module(name)),
        // Also for a module whose source could not be parsed at all.
        ErrSource::Constructing { path, .. } => library.by_file(path),
    };
    let file = module.unwrap_or(entry);
    let known = module.is_some() || matches!(error.source, ErrSource::Constructing { .. });
    // The end of the source belongs to its last line.
    let last = file.source.lines().count().max(1);
    let line = if known { line_of(error, composer).min(last) } else { 1 };
    Error::Wgsl {
        file: file.file.to_string(),
        line,
        message: printable(&plain_names(&message_of(&error.inner))),
        text: printable(file.source.lines().nth(line - 1).unwrap_or_default().trim()),
    }
}

/// Returns the line, from 1. Composition preserves line numbers.
fn line_of(error: &ComposerError, composer: &Composer) -> usize {
    if let ComposerErrorInner::InvalidWgslDirective { position, .. } = &error.inner {
        return position + 1;
    }
    let source = error.source.source(composer);
    let offset = offset_of(&error.inner, error.source.offset());
    let before = source.as_bytes().iter().take(offset);
    before.filter(|byte| **byte == b'\n').count() + 1
}

/// Returns the byte offset of the error in its file.
fn offset_of(inner: &ComposerErrorInner, header: usize) -> usize {
    use ComposerErrorInner as E;
    match inner {
        E::WgslParseError(error) => {
            let start = error.labels().find_map(|(span, _)| span.to_range()).map_or(0, |range| range.start);
            start.saturating_sub(header)
        }
        E::ShaderValidationError(error) | E::HeaderValidationError(error) => {
            let spans = || error.spans().filter_map(|(span, _)| span.to_range());
            let module = spans().last().map(|span| span.start >> OFFSET_BITS);
            let inside = spans().filter(|span| Some(span.start >> OFFSET_BITS) == module);
            // The spans include the whole function: the shortest is the most precise.
            let start = inside.min_by_key(ExactSizeIterator::len).map_or(0, |span| span.start);
            (start & ((1 << OFFSET_BITS) - 1)).saturating_sub(header)
        }
        E::InvalidIdentifier { at, .. } => {
            at.to_range().map_or(0, |range| range.start).saturating_sub(header)
        }
        E::DecorationInSource(range) => range.start,
        E::ImportParseError(_, offset)
        | E::ImportNotFound(_, offset)
        | E::NotEnoughEndIfs(offset)
        | E::TooManyEndIfs(offset)
        | E::ElseWithoutCondition(offset)
        | E::DefineInModule(offset)
        | E::UnknownShaderDefOperator { pos: offset, .. }
        | E::UnknownShaderDef { pos: offset, .. }
        | E::InvalidShaderDefComparisonValue { pos: offset, .. }
        | E::OverrideNotVirtual { pos: offset, .. }
        | E::InvalidShaderDefDefinitionValue { pos: offset, .. } => *offset,
        _ => 0,
    }
}

/// Returns the message with its causes.
fn message_of(inner: &ComposerErrorInner) -> String {
    match inner {
        ComposerErrorInner::WgslParseError(error) => {
            let message = error.message();
            // The label often repeats the message.
            let label = error.labels().map(|(_, label)| label).find(|label| !label.is_empty());
            match label.filter(|label| !message.contains(label)) {
                Some(label) => format!("{message} ({label})"),
                None => message.to_owned(),
            }
        }
        ComposerErrorInner::ShaderValidationError(error)
        | ComposerErrorInner::HeaderValidationError(error) => {
            let mut message = error.as_inner().to_string();
            let mut cause = error.as_inner().source();
            while let Some(reason) = cause {
                message.push_str(": ");
                message.push_str(&reason.to_string());
                cause = reason.source();
            }
            message
        }
        ComposerErrorInner::InvalidIdentifier { original, .. } => format!(
            "`{original}` cannot be exported from a module: a name must not end in a digit, contain two underscores \
             in a row or be a reserved word"
        ),
        other => other.to_string(),
    }
}

/// Replaces control characters by spaces, to keep a string on one line.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Removes naga_oil's decorations from all names in a string.
pub(crate) fn plain_names(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((start, mark)) =
        NAME_DECORATIONS.iter().filter_map(|mark| Some((rest.find(mark)?, mark))).min()
    {
        plain.push_str(&rest[..start]);
        let path = &rest[start + mark.len()..];
        rest = path.trim_start_matches(|c: char| c.is_ascii_uppercase() || c.is_ascii_digit());
    }
    plain.push_str(rest);
    plain
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decorations_are_removed_from_all_names() {
        let decorated = Composer::decorated_name(Some("shadowgraph::view"), "View");
        assert_eq!(plain_names(&format!("[{decorated}, {decorated}] and View")), "[View, View] and View");
    }
}
