//! The plan for people and tools. Every decision has a sentence, in `words`; the dumps arrange the sentences.

mod dot;
mod explain;
mod json;
mod places;
mod text;
mod words;
