//! Passes of one shader: declared in one line by what they bind and where they draw or how much they dispatch.

mod builder;
mod declaration;
mod record;
mod warm;

#[cfg(test)]
mod tests;

pub use builder::ShaderPassBuilder;
pub(crate) use declaration::ShaderPasses;
pub use declaration::UniformSource;
pub(crate) use record::{dispatch, draw};
