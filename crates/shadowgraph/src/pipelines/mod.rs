//! Pipelines: connected nodes, as a file or as a script with one call per step.
//!
//! A pipeline file names nodes of [`Nodes`](crate::nodes::Nodes) and connects their outputs to inputs ([`Pipeline::load`]). A
//! pipeline in Rust is a [`PipelineInstance`], such as `examples/custom_pipeline/script.rs`. Both give the same plans.

pub(crate) mod file;
pub(crate) mod instance;
pub(crate) mod pipeline;

pub use crate::error::PipelineError;
pub use file::parameters::Parameters;
pub use file::schema::schema;
pub use instance::{PipelineInstance, PipelineOutput};
pub use pipeline::{BUILT_IN, Pipeline};

#[cfg(test)]
mod tests;
