//! The warnings of an import; equal ones are counted.

use super::error::ImportError;

/// The maximum number of lines.
const MAX_LINES: usize = 50;

/// Collects warnings about what is not drawn as the file says. Equal warnings become one line.
#[derive(Debug, Default)]
pub(super) struct Notes {
    notes: Vec<Note>,
    omitted: usize,
}

#[derive(Debug)]
struct Note {
    text: String,
    first_location: String,
    more: usize,
}

impl Notes {
    /// Adds a note about a location; the same text at further locations is only counted.
    pub(super) fn add(&mut self, location: impl std::fmt::Display, text: impl std::fmt::Display) {
        let note = ImportError::new(location, text);
        let full = self.notes.len() == MAX_LINES;
        match self.notes.iter_mut().find(|known| known.text == note.reason) {
            Some(known) => known.more += 1,
            None if full => self.omitted += 1,
            None => self.notes.push(Note { text: note.reason, first_location: note.location, more: 0 }),
        }
    }

    /// Returns the lines in the order of their first occurrence.
    pub(super) fn into_lines(self) -> Vec<String> {
        let line = |note: Note| match note.more {
            0 => format!("{}: {}", note.first_location, note.text),
            more => format!("{} and {more} more: {}", note.first_location, note.text),
        };
        let omitted = self.omitted;
        let last = (omitted > 0).then(|| format!("{omitted} more notes are omitted"));
        self.notes.into_iter().map(line).chain(last).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_lines_is_limited() {
        let mut notes = Notes::default();
        (0..MAX_LINES + 7).for_each(|i| notes.add("extensionsUsed", i));
        let lines = notes.into_lines();
        assert_eq!(
            (lines.len(), lines.last().map(String::as_str)),
            (MAX_LINES + 1, Some("7 more notes are omitted"))
        );
    }

    #[test]
    fn equal_notes_become_one_line_with_a_count() {
        let mut notes = Notes::default();
        notes.add("mesh 0", "points are not drawn");
        notes.add("animation", "drawn at rest");
        notes.add("mesh 4", "points are not drawn");
        assert_eq!(
            notes.into_lines(),
            ["mesh 0 and 1 more: points are not drawn", "animation: drawn at rest"]
        );
    }
}
