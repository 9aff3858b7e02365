//! Turns naga_oil's errors into a file, a line and a sentence.

use std::error::Error as _;

use naga_oil::compose::{Composer, ComposerError, ComposerErrorInner, ErrSource};

use crate::{Error, ModuleSource, imports::Library};

/// naga_oil puts the number of the module into the upper bits of a place in the text.
const PLACE_BITS: u32 = 21;

/// What naga_oil adds to names, up to the encoded import path and an `X`.
const NAME_MARKS: [&str; 2] = ["X_naga_oil_mod_X", "X_naga_oil_vrt_X"];

/// Says where and what an error of composition is.
pub(crate) fn wgsl_error(
    error: &ComposerError,
    composer: &Composer,
    library: &Library<'_>,
    entry: &ModuleSource,
) -> Error {
    let module = match &error.source {
        ErrSource::Module { name, .. } => library.get(name).filter(|_| composer.contains_module(name)),
        // Also a module's, where its text could not be read at all.
        ErrSource::Constructing { path, .. } => library.by_file(path),
    };
    let file = module.unwrap_or(entry);
    let known = module.is_some() || matches!(error.source, ErrSource::Constructing { .. });
    // The end of the text counts to its last line.
    let last = file.source.lines().count().max(1);
    let line = if known { line_of(error, composer).min(last) } else { 1 };
    Error::Wgsl {
        file: file.file.to_string(),
        line,
        message: printable(&plain_names(&message_of(&error.inner))),
        text: printable(file.source.lines().nth(line - 1).unwrap_or_default().trim()),
    }
}

/// The line, from 1. Composition keeps the number of lines.
fn line_of(error: &ComposerError, composer: &Composer) -> usize {
    if let ComposerErrorInner::InvalidWgslDirective { position, .. } = &error.inner {
        return position + 1;
    }
    let source = error.source.source(composer);
    let place = place_of(&error.inner, error.source.offset());
    let before = source.as_bytes().iter().take(place);
    before.filter(|byte| **byte == b'\n').count() + 1
}

/// How many bytes stand before the error in its file.
fn place_of(inner: &ComposerErrorInner, header: usize) -> usize {
    use ComposerErrorInner as E;
    match inner {
        E::WgslParseError(error) => {
            let start = error.labels().find_map(|(span, _)| span.to_range()).map_or(0, |range| range.start);
            start.saturating_sub(header)
        }
        E::ShaderValidationError(error) | E::HeaderValidationError(error) => {
            let spans = || error.spans().filter_map(|(span, _)| span.to_range());
            let module = spans().last().map(|span| span.start >> PLACE_BITS);
            let inside = spans().filter(|span| Some(span.start >> PLACE_BITS) == module);
            // The whole function is one of them: the shortest says most.
            let start = inside.min_by_key(ExactSizeIterator::len).map_or(0, |span| span.start);
            (start & ((1 << PLACE_BITS) - 1)).saturating_sub(header)
        }
        E::InvalidIdentifier { at, .. } => {
            at.to_range().map_or(0, |range| range.start).saturating_sub(header)
        }
        E::DecorationInSource(range) => range.start,
        E::ImportParseError(_, place)
        | E::ImportNotFound(_, place)
        | E::NotEnoughEndIfs(place)
        | E::TooManyEndIfs(place)
        | E::ElseWithoutCondition(place)
        | E::DefineInModule(place)
        | E::UnknownShaderDefOperator { pos: place, .. }
        | E::UnknownShaderDef { pos: place, .. }
        | E::InvalidShaderDefComparisonValue { pos: place, .. }
        | E::OverrideNotVirtual { pos: place, .. }
        | E::InvalidShaderDefDefinitionValue { pos: place, .. } => *place,
        _ => 0,
    }
}

/// The sentence, with the reasons below it.
fn message_of(inner: &ComposerErrorInner) -> String {
    match inner {
        ComposerErrorInner::WgslParseError(error) => {
            let message = error.message();
            // The label often says the same again.
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
            "`{original}` cannot be exported from a module: a name must not end in a digit, hold two underscores \
             in a row or be a reserved word"
        ),
        other => other.to_string(),
    }
}

/// Keeps a text to one line.
fn printable(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}

/// Takes naga_oil's marks off all names in a text.
pub(crate) fn plain_names(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((start, mark)) = NAME_MARKS.iter().filter_map(|mark| Some((rest.find(mark)?, mark))).min()
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
    fn marks_are_taken_off_all_names() {
        let decorated = Composer::decorated_name(Some("shadowgraph::view"), "View");
        assert_eq!(plain_names(&format!("[{decorated}, {decorated}] and View")), "[View, View] and View");
    }
}
