//! Files in RON: errors name the file, the line, the column and what is expected.

use std::fmt;

use ron::Options;
use ron::error::SpannedError;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use shadowgraph_core::did_you_mean;

/// An error in a file, with its location: `file:line:column`, or the file alone.
#[derive(Debug, PartialEq, Eq)]
pub struct ParseError {
    /// `file:line:column`, or the file alone.
    pub location: String,
    /// The problem, and what is allowed.
    pub problem: String,
}

impl fmt::Display for ParseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.location, self.problem)
    }
}

impl std::error::Error for ParseError {}

/// Parses the text of a file; `Some` need not be written.
///
/// # Errors
/// The problem, and its location.
pub fn parse_file<'t, T: Deserialize<'t>>(file: &str, text: &'t str) -> Result<T, ParseError> {
    parse_text(text)
        .map_err(|(offset, problem)| ParseError { location: location(file, text, offset), problem })
}

/// Parses a string.
///
/// # Errors
/// The offset of the error in bytes, and what is wrong.
pub fn parse_text<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, (usize, String)> {
    options().from_str(text).map_err(|error| match text.trim() {
        "" => (0, "the file is empty".to_owned()),
        _ => describe(text, &error),
    })
}

/// Returns the offset of an error in bytes, and what is wrong.
fn describe(text: &str, error: &SpannedError) -> (usize, String) {
    if error.code == ron::Error::Eof {
        return (text.trim_end().len(), problem(&error.code));
    }
    let offset = offset_of_error(text, error.span.start);
    let (before, after) = text.split_at_checked(offset).unwrap_or((text, ""));
    let no_letter = |c: char| !c.is_alphanumeric() && c != '_';
    let name = before.rsplit(no_letter).next().unwrap_or_default();
    let word = after.split(no_letter).next().unwrap_or_default();
    use ron::Error as E;
    let problem = match &error.code {
        E::ExpectedComma if after.starts_with('.') => problem(&E::ExpectedInteger),
        E::ExpectedComma if before.trim_end().ends_with('"') && !word.is_empty() => {
            "expected a comma, or a quote before it".to_owned()
        }
        E::ExpectedString if !word.is_empty() => format!("expected a string in quotes: \"{word}\""),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) if !name.is_empty() => {
            format!("expected the values of `{name}` in parentheses: {name}(...)")
        }
        code => problem(code),
    };
    (offset, one_line(&problem))
}

/// Returns the offset of the parser's position, or of the next character that is no blank.
fn offset_of_error(text: &str, position: ron::error::Position) -> usize {
    let start: usize = text.split_inclusive('\n').take(position.line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(start..).unwrap_or_default();
    let column = rest.char_indices().nth(position.col.saturating_sub(1));
    let offset = start + column.map_or(rest.len(), |(index, _)| index);
    let rest = text.get(offset..).unwrap_or_default();
    let blank = rest.len() - rest.trim_start().len();
    if blank < rest.len() { offset + blank } else { offset }
}

fn options() -> Options {
    Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// Returns `file:line:column`, from 1.
pub fn location(file: &str, text: &str, offset: usize) -> String {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    format!("{file}:{line}:{column}")
}

/// Returns an error about the value at a path of fields and indices, such as `cases.0.views`. If the text does not have the value,
/// the location is that of the closest value around it, or the file.
pub fn field_error(file: &str, text: &str, path: &str, problem: impl fmt::Display) -> ParseError {
    let location = match values(text, path).last() {
        Some(value) => location(file, text, offset_of(text, value)),
        None => file.to_owned(),
    };
    ParseError { location, problem: one_line(&problem.to_string()) }
}

/// Returns an error inside the value at a path, which was parsed separately with this error; `owner` begins the message.
pub fn nested_error(file: &str, text: &str, path: &str, owner: &str, error: &SpannedError) -> ParseError {
    let Some(value) = values(text, path).pop() else {
        let problem = one_line(&format!("{owner}: {}", problem(&error.code)));
        return ParseError { location: file.to_owned(), problem };
    };
    let (offset, problem) = describe(value.get_ron(), error);
    let location = location(file, text, start_of(text, value) + offset);
    ParseError { location, problem: format!("{owner}: {problem}") }
}

/// Returns the values along a path of fields and indices, from the outermost to the innermost that the text has.
fn values<'t>(text: &'t str, path: &str) -> Vec<&'t RawValue> {
    let mut found: Vec<&RawValue> = Vec::new();
    for field in path.split('.') {
        let part = found.last().map_or(text, |value| value.get_ron());
        let Ok(Fields(fields)) = options().from_str::<Fields<'_>>(part) else { break };
        let Some((_, value)) = fields.into_iter().find(|(name, _)| name == field) else { break };
        found.push(value);
    }
    found
}

/// Returns the offset in bytes of a raw value, including blanks before it. Raw values are slices of the text that they were parsed
/// from.
pub fn start_of(text: &str, raw: &RawValue) -> usize {
    (raw.get_ron().as_ptr() as usize).saturating_sub(text.as_ptr() as usize)
}

/// Returns the offset in bytes of a raw value, after the blanks before it.
pub fn offset_of(text: &str, raw: &RawValue) -> usize {
    let inner = raw.get_ron();
    start_of(text, raw) + inner.len() - inner.trim_start().len()
}

/// The fields of a struct, the entries of a map, or the elements of a list by index.
struct Fields<'t>(Vec<(String, &'t RawValue)>);

impl<'de: 't, 't> Deserialize<'de> for Fields<'t> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl<'de> Visitor<'de> for Reader {
            type Value = Fields<'de>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("fields")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut fields = Vec::new();
                while let Some((Name(name), value)) = map.next_entry()? {
                    fields.push((name, value));
                }
                Ok(Fields(fields))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                let mut elements = Vec::new();
                while let Some(value) = seq.next_element()? {
                    elements.push((elements.len().to_string(), value));
                }
                Ok(Fields(elements))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// The name of a field, or a string.
struct Name(String);

impl<'de> Deserialize<'de> for Name {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Reader;
        impl Visitor<'_> for Reader {
            type Value = Name;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a name")
            }

            fn visit_str<E>(self, name: &str) -> Result<Name, E> {
                Ok(Name(name.to_owned()))
            }
        }
        deserializer.deserialize_any(Reader)
    }
}

/// Returns the parser's message, for people who write files and not Rust.
fn problem(error: &ron::Error) -> String {
    use ron::Error as E;
    let problem = match error {
        E::NoSuchStructField { found, expected, .. } => {
            return format!("unknown field `{found}`{}", did_you_mean(found, expected.iter().copied()));
        }
        E::NoSuchEnumVariant { found, expected, .. } => {
            return format!("unknown value `{found}`{}", did_you_mean(found, expected.iter().copied()));
        }
        E::MissingStructField { field, .. } => return format!("missing field `{field}`"),
        E::DuplicateStructField { field, .. } => return format!("duplicate field `{field}`"),
        E::Eof => "unexpected end of the file; expected ), ], } or \"",
        E::ExpectedComma => "expected a comma or one of ) ] }",
        E::ExpectedMapColon => "expected a colon between a name and its value",
        E::ExpectedArray => "expected a list, such as [1, 2]",
        E::ExpectedArrayEnd => "expected ] at the end of the list",
        E::ExpectedMap => "expected a map, such as {\"name\": 1}",
        E::ExpectedMapEnd => "expected } at the end of the map",
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) | E::ExpectedUnit => {
            "expected a struct in parentheses, such as (field: 1)"
        }
        E::ExpectedStructLikeEnd | E::ExpectedOptionEnd => "expected ) at the end of a struct",
        E::ExpectedBoolean => "expected true or false",
        E::ExpectedInteger | E::InvalidIntegerDigit { .. } => "expected an integer, such as 4",
        E::ExpectedFloat | E::UnderscoreAtBeginning | E::FloatUnderscore => "expected a number, such as 0.5",
        E::IntegerOutOfBounds => "the integer is too large, or negative",
        E::ExpectedString => "expected a string in quotes, such as \"name\"",
        E::ExpectedStringEnd => "expected a quote at the end of the string",
        E::ExpectedIdentifier | E::InvalidIdentifier(_) | E::SuggestRawIdentifier(_) => {
            "expected a name without quotes, such as count in (count: 4), On(\"bloom\"), or Tent5"
        }
        E::ExpectedDifferentStructName { .. } => "expected a struct in parentheses, such as (field: 1)",
        E::TrailingCharacters => {
            "unexpected text after the end of the value: is a parenthesis closed too early?"
        }
        E::UnclosedBlockComment => "expected */ at the end of the comment",
        E::UnexpectedChar('#') => "unexpected '#'; comments begin with //",
        E::UnexpectedChar('$') => "unexpected '$'; write a parameter in quotes, \"$name\"",
        E::UnexpectedChar(found) => return format!("unexpected {found:?}"),
        E::ExceededRecursionLimit => "values are nested too deep",
        other => return other.to_string(),
    };
    problem.to_owned()
}

/// Escapes control characters, so that a message stays in one line.
pub fn one_line(text: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;

    #[test]
    fn a_field_is_found_by_its_path_through_structs_variants_and_maps() {
        let text = "(\n  first: 1,\n  cascades: ( count: 9, split: Practical(lambda: 2.0)),\n  techniques: {\"evsm\": (blur_px: 99)},\n)";
        let at = |path: &str| field_error("a.ron", text, path, "").location;
        assert_eq!(at("first"), "a.ron:2:10");
        assert_eq!(at("cascades.count"), "a.ron:3:22");
        assert_eq!(at("cascades.split.lambda"), "a.ron:3:50");
        assert_eq!(at("techniques.evsm.blur_px"), "a.ron:4:34");
        assert_eq!(at("cascades.depth_bias"), "a.ron:3:13", "the struct without the field");
        assert_eq!(at("filter"), "a.ron");
        assert_eq!(field_error("a.ron", "[(x: 1), (x: 2)]", "1.x", "odd").to_string(), "a.ron:1:14: odd");
    }

    #[test]
    fn characters_are_counted_and_not_bytes() {
        let error = parse_file::<(String, f32)>("a.ron", "(\"äöü\", x)").unwrap_err();
        assert_eq!(error.location, "a.ron:1:9");
        assert_eq!(location("a.ron", "äö\nüx", 7), "a.ron:2:2");
    }
}
