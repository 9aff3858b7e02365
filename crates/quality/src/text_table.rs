//! Tables of text for a terminal.

use tabled::builder::Builder;
use tabled::settings::object::Columns;
use tabled::settings::peaker::PriorityMax;
use tabled::settings::{Alignment, Padding, Style, Width};

/// The layout of a table: columns as wide as their widest cell, two blanks apart.
#[derive(Clone, Copy, Debug)]
pub struct TextTable<'a> {
    /// A letter for each column: `l` for left-aligned, `r` for right-aligned, as numbers are.
    pub alignment: &'a str,
    /// Number of blanks before each row.
    pub indent: usize,
    /// Maximum length of a line, or `usize::MAX`. The widest columns are truncated until the table fits.
    pub width: usize,
}

impl TextTable<'_> {
    /// Formats rows of cells, one line each. Cells must not contain line breaks.
    ///
    /// ```
    /// use shadowgraph_quality::TextTable;
    /// let table = TextTable { alignment: "lr", indent: 2, width: 80 };
    /// assert_eq!(table.format([["pass", "ms"], ["tonemap", "0.125"]]), "  pass        ms\n  tonemap  0.125\n");
    /// ```
    pub fn format<R>(&self, rows: impl IntoIterator<Item = R>) -> String
    where
        R: IntoIterator<Item: Into<String>>,
    {
        let mut table = Builder::from_iter(rows).build();
        table.with(Style::empty()).with(Padding::new(0, 2, 0, 0));
        for (column, letter) in self.alignment.chars().enumerate() {
            let alignment = if letter == 'r' { Alignment::right() } else { Alignment::left() };
            table.modify(Columns::one(column), alignment);
        }
        // The last column is padded too.
        let width = self.width.saturating_add(2).saturating_sub(self.indent);
        table.with(Width::truncate(width).suffix("\u{2026}").priority(PriorityMax::right()));
        let indent = " ".repeat(self.indent);
        let lines = table.to_string();
        lines.lines().map(|line| format!("{indent}{line}").trim_end().to_owned() + "\n").collect()
    }
}

#[cfg(test)]
mod tests {
    use super::TextTable;

    #[test]
    fn the_widest_column_is_truncated_and_lines_end_without_blanks() {
        let table = TextTable { alignment: "llr", indent: 1, width: 20 };
        let rows = [vec!["a", "a name that is long", "1.5"], Vec::new(), vec!["b", "", "10.25"], vec!["c"]];
        assert_eq!(table.format(rows), " a  a name t\u{2026}    1.5\n\n b             10.25\n c\n");
    }

    #[test]
    fn a_table_without_rows_is_empty() {
        assert_eq!(TextTable { alignment: "lr", indent: 2, width: 80 }.format(Vec::<[&str; 2]>::new()), "");
    }
}
