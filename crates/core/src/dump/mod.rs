//! The plan for people and tools. `describe` has a sentence for every decision; the dumps arrange the sentences.

pub mod describe;
mod dot;
mod json;
mod mermaid;
mod text;

pub use json::JSON_SCHEMA;
