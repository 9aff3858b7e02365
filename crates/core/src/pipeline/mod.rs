//! Shaders of fullscreen and compute passes, and their pipelines.

mod cache;
mod shader;
mod targets;
mod validation;

pub(crate) use cache::PipelineCache;
pub(crate) use shader::ProgrammableStage;
pub use shader::{ComputeShader, FullscreenShader};
pub(crate) use targets::{DepthTarget, PipelineTargets};
