//! Names, stored in one string of the frame instead of an allocation each.

use std::fmt::{Arguments, Write as _};

/// Values that can be used as a name: strings, and `format_args!("tile {index}")`, which allocates nothing.
pub trait Name {
    /// Appends the name to `text`.
    fn write_to(&self, text: &mut String);
}

impl Name for str {
    fn write_to(&self, text: &mut String) {
        text.push_str(self);
    }
}

impl Name for String {
    fn write_to(&self, text: &mut String) {
        text.push_str(self);
    }
}

impl Name for Arguments<'_> {
    fn write_to(&self, text: &mut String) {
        match self.as_str() {
            Some(name) => text.push_str(name),
            // Only a failing `Display` of the caller can fail; the name is then cut short.
            None => drop(text.write_fmt(*self)),
        }
    }
}

impl<N: Name + ?Sized> Name for &N {
    fn write_to(&self, text: &mut String) {
        (**self).write_to(text);
    }
}

/// A name, as a range of the frame's string.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Text {
    start: u32,
    end: u32,
}

/// All names of a frame, concatenated.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Names(String);

impl Names {
    pub(crate) fn push(&mut self, name: impl Name) -> Text {
        let start = self.0.len() as u32;
        name.write_to(&mut self.0);
        Text { start, end: self.0.len() as u32 }
    }

    pub(crate) fn get(&self, text: Text) -> &str {
        &self.0[text.start as usize..text.end as usize]
    }

    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }
}
