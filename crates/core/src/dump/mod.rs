//! The plan for people and tools.

mod dot;
mod json;
mod text;
mod words;
