//! The plan for people and tools. `describe` has a sentence for every decision; the dumps arrange the sentences.

mod describe;
mod diff;
mod dot;
mod explain;
mod html;
mod json;
mod mermaid;
mod positions;
mod summary;
mod text;

pub use diff::{Diff, Difference, Dump, Subject};
pub use html::{Drawing, HtmlPage, Outline, PageTable, SnapshotTile, TexelValues, Texels, TextureSnapshot};
