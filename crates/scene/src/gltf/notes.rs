//! The warning lines of an import, equal ones counted.

use super::fault::fault;

/// The most lines that are kept.
const MAX_LINES: usize = 50;

/// Collects what is not drawn as written. Each kind of note is one line, however often it occurs.
#[derive(Debug, Default)]
pub(super) struct Notes {
    notes: Vec<Note>,
    left_out: usize,
}

#[derive(Debug)]
struct Note {
    text: String,
    first_place: String,
    more: usize,
}

impl Notes {
    /// Adds a note about a place; the same text at further places is only counted.
    pub(super) fn add(&mut self, place: impl std::fmt::Display, text: impl std::fmt::Display) {
        let note = fault(place, text);
        let full = self.notes.len() == MAX_LINES;
        match self.notes.iter_mut().find(|known| known.text == note.reason) {
            Some(known) => known.more += 1,
            None if full => self.left_out += 1,
            None => self.notes.push(Note { text: note.reason, first_place: note.place, more: 0 }),
        }
    }

    /// Returns the lines in the order in which they first came up.
    pub(super) fn into_lines(self) -> Vec<String> {
        let line = |note: Note| match note.more {
            0 => format!("{}: {}", note.first_place, note.text),
            more => format!("{} and {more} more: {}", note.first_place, note.text),
        };
        let left_out = self.left_out;
        let last = (left_out > 0).then(|| format!("{left_out} further notes are left out"));
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
            (MAX_LINES + 1, Some("7 further notes are left out"))
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
