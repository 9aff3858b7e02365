//! The plan for people and tools. Every decision has a sentence, in `words`; the dumps arrange the sentences.

mod diff;
mod dot;
mod explain;
mod html;
mod json;
mod mermaid;
mod places;
mod text;
mod words;

pub use diff::{Diff, Difference, Subject};
pub use html::{Drawing, HtmlPage, Outline, Picture, PictureTile, TexelValues, Texels};
