//! Files in RON: what is wrong in them is told with the file, the line, the column and the way out.

use std::fmt;

use ron::Options;
use ron::error::SpannedError;
use ron::extensions::Extensions;
use ron::value::RawValue;
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::nodes::near_words;

/// What is wrong in a file, and where: `file:line:column`, or the file alone.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Wrong {
    pub(crate) place: String,
    pub(crate) problem: String,
}

impl fmt::Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)
    }
}

impl From<Wrong> for crate::Error {
    fn from(Wrong { place, problem }: Wrong) -> Self {
        Self::Cases { place, reason: problem }
    }
}

/// Reads a value from the text of a file; `Some` need not be written.
///
/// # Errors
/// What is wrong, and where.
pub(crate) fn read<'t, T: Deserialize<'t>>(file: &str, text: &'t str) -> Result<T, Wrong> {
    read_at(text).map_err(|(offset, problem)| Wrong { place: place(file, text, offset), problem })
}

/// Reads a value from a text.
///
/// # Errors
/// Where it is wrong, in bytes from the begin, and what is.
pub(crate) fn read_at<'t, T: Deserialize<'t>>(text: &'t str) -> Result<T, (usize, String)> {
    options().from_str(text).map_err(|error| match text.trim() {
        "" => (0, "there is nothing in the file".to_owned()),
        _ => told(text, &error),
    })
}

/// Where a text is wrong, in bytes from the begin, and what is.
fn told(text: &str, error: &SpannedError) -> (usize, String) {
    if error.code == ron::Error::Eof {
        return (text.trim_end().len(), problem(&error.code));
    }
    let offset = offset_of_error(text, error.span.start);
    let (before, after) = text.split_at_checked(offset).unwrap_or((text, ""));
    let no_letter = |c: char| !c.is_alphanumeric() && c != '_';
    let name = before.rsplit(no_letter).next().unwrap_or_default();
    let word = after.split(no_letter).next().unwrap_or_default();
    use ron::Error as E;
    let words = match &error.code {
        E::ExpectedComma if after.starts_with('.') => problem(&E::ExpectedInteger),
        E::ExpectedComma if before.trim_end().ends_with('"') && !word.is_empty() => {
            "a comma is missing here, or a quote before it".to_owned()
        }
        E::ExpectedString if !word.is_empty() => format!("a text stands in quotes: \"{word}\""),
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) if !name.is_empty() => {
            format!("`{name}` needs its values in brackets here: {name}(...)")
        }
        code => problem(code),
    };
    (offset, one_line(&words))
}

/// Where the parser stood, and from there the next thing that is no blank.
fn offset_of_error(text: &str, at: ron::error::Position) -> usize {
    let start: usize = text.split_inclusive('\n').take(at.line.saturating_sub(1)).map(str::len).sum();
    let rest = text.get(start..).unwrap_or_default();
    let column = rest.char_indices().nth(at.col.saturating_sub(1));
    let offset = start + column.map_or(rest.len(), |(at, _)| at);
    let rest = text.get(offset..).unwrap_or_default();
    let blank = rest.len() - rest.trim_start().len();
    if blank < rest.len() { offset + blank } else { offset }
}

fn options() -> Options {
    Options::default().with_default_extension(Extensions::IMPLICIT_SOME)
}

/// A place in words: file, line and column, from 1.
pub(crate) fn place(file: &str, text: &str, offset: usize) -> String {
    let before = text.get(..offset).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or_default().chars().count() + 1;
    format!("{file}:{line}:{column}")
}

/// What is wrong with the value behind a path of fields and indices, such as `cases.0.views`. The place is that of the nearest
/// value around it that stands in the text, or the file where that is none.
pub(crate) fn wrong_field(file: &str, text: &str, path: &str, problem: impl fmt::Display) -> Wrong {
    let place = match values(text, path).last() {
        Some(value) => place(file, text, offset_of(text, value)),
        None => file.to_owned(),
    };
    Wrong { place, problem: one_line(&problem.to_string()) }
}

/// What is wrong inside the value behind a path, which was read by itself with this error; `whose` begins the words.
pub(crate) fn wrong_inside(file: &str, text: &str, path: &str, whose: &str, error: &SpannedError) -> Wrong {
    let Some(value) = values(text, path).pop() else {
        return Wrong {
            place: file.to_owned(),
            problem: one_line(&format!("{whose}: {}", problem(&error.code))),
        };
    };
    let (offset, problem) = told(value.get_ron(), error);
    Wrong { place: place(file, text, start_of(text, value) + offset), problem: format!("{whose}: {problem}") }
}

/// The values behind a path of fields and indices, from the outermost to the innermost that stands in the text.
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

/// The value behind a path of fields and indices, as it stands in a text; `None` where it does not.
pub(crate) fn value<'t>(text: &'t str, path: &str) -> Option<&'t str> {
    let found = values(text, path);
    (found.len() == path.split('.').count()).then(|| found.last().map(|value| value.get_ron().trim()))?
}

/// Where a raw part of a text begins, in bytes, blanks before the value included. Raw values are slices of the text that they were
/// read from.
pub(crate) fn start_of(text: &str, raw: &RawValue) -> usize {
    (raw.get_ron().as_ptr() as usize).saturating_sub(text.as_ptr() as usize)
}

/// Where the value of a raw part of a text begins, in bytes.
pub(crate) fn offset_of(text: &str, raw: &RawValue) -> usize {
    let inner = raw.get_ron();
    start_of(text, raw) + inner.len() - inner.trim_start().len()
}

/// The fields of a record, the entries of a map with names, or the elements of a list by index.
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

/// The name of a field, or a text.
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

/// The parser's words, for people who write files and not Rust.
fn problem(error: &ron::Error) -> String {
    use ron::Error as E;
    let words = match error {
        E::NoSuchStructField { found, expected, .. } => {
            return format!(
                "there is no field `{found}` here{}",
                near_words(found, expected.iter().copied())
            );
        }
        E::NoSuchEnumVariant { found, expected, .. } => {
            return format!("there is no `{found}` here{}", near_words(found, expected.iter().copied()));
        }
        E::MissingStructField { field, .. } => return format!("the field `{field}` is missing here"),
        E::DuplicateStructField { field, .. } => return format!("the field `{field}` stands here twice"),
        E::Eof => "the file ends too early: close what is open, with ), ], } or \"",
        E::ExpectedComma => "a comma is missing here, or a closing bracket",
        E::ExpectedMapColon => "a colon is missing here, between a name and its value",
        E::ExpectedArray => "a list has to stand here, such as [1, 2]",
        E::ExpectedArrayEnd => "the list is not closed: ] is missing here",
        E::ExpectedMap => "a map has to stand here, such as {\"name\": 1}",
        E::ExpectedMapEnd => "the map is not closed: } is missing here",
        E::ExpectedStructLike | E::ExpectedNamedStructLike(_) | E::ExpectedUnit => {
            "a record has to stand here, such as (field: 1)"
        }
        E::ExpectedStructLikeEnd | E::ExpectedOptionEnd => "a record is not closed: ) is missing here",
        E::ExpectedBoolean => "true or false has to stand here",
        E::ExpectedInteger | E::InvalidIntegerDigit { .. } => "a whole number has to stand here, such as 4",
        E::ExpectedFloat | E::UnderscoreAtBeginning | E::FloatUnderscore => {
            "a number has to stand here, such as 0.5"
        }
        E::IntegerOutOfBounds => {
            "the number is too large or too small: a whole number from 0 on has to stand here"
        }
        E::ExpectedString => "a text in quotes has to stand here, such as \"name\"",
        E::ExpectedStringEnd => "the text is not closed: a quote is missing",
        E::ExpectedIdentifier | E::InvalidIdentifier(_) | E::SuggestRawIdentifier(_) => {
            "a name without quotes has to stand here, such as count in (count: 4), On(\"bloom\"), or Tent5"
        }
        E::ExpectedDifferentStructName { .. } => "a record in brackets has to stand here, such as (field: 1)",
        E::TrailingCharacters => {
            "there is more behind the end of the file's value: is a bracket closed too early?"
        }
        E::UnclosedBlockComment => "the comment is not closed: */ is missing",
        E::UnexpectedChar('#') => "'#' cannot stand here; comments begin with //",
        E::UnexpectedChar('$') => "'$' cannot stand here; \"$name\" in quotes stands for a parameter",
        E::UnexpectedChar(found) => return format!("{found:?} cannot stand here"),
        E::ExceededRecursionLimit => "the brackets are nested too deep",
        other => return other.to_string(),
    };
    words.to_owned()
}

/// Words in one line, whatever stands in the names that they quote.
pub(crate) fn one_line(words: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    words.chars().map(escaped).collect()
}

#[cfg(test)]
mod tests;
