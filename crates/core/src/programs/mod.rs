//! Passes of one line: a shader, what it binds, and where it draws or how much it dispatches.

mod block;
mod call;
mod declared;
mod objection;
mod pipelines;
mod record;
mod shader;
mod warm;

#[cfg(test)]
mod tests;

pub use block::Block;
pub use call::Call;
pub(crate) use declared::Calls;
pub(crate) use pipelines::Pipelines;
pub(crate) use record::{dispatch, draw};
pub(crate) use shader::Program;
pub use shader::{ComputeShader, FullscreenShader};
