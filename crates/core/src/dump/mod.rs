//! The plan for people and tools. Every decision has a sentence, in `words`; the dumps arrange the sentences.

mod diff;
mod dot;
mod explain;
mod html;
mod json;
mod mermaid;
mod places;
mod summary;
mod text;
mod words;

pub use diff::{Diff, Difference, Dump, Subject};
pub use html::{Drawing, HtmlPage, Outline, PageTable, SnapshotTile, TexelValues, Texels, TextureSnapshot};
