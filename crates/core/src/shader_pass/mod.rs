//! Passes of one shader: declared in one line by what they bind and where they draw or how much they dispatch.

mod builder;
mod declaration;
mod pipeline_cache;
mod record;
mod shader;
mod uniform_source;
mod validation;
mod warm;

#[cfg(test)]
mod tests;

pub use builder::ShaderPassBuilder;
pub(crate) use declaration::ShaderPasses;
pub(crate) use pipeline_cache::Pipelines;
pub(crate) use record::{dispatch, draw};
pub(crate) use shader::Program;
pub use shader::{ComputeShader, FullscreenShader};
pub use uniform_source::UniformSource;
