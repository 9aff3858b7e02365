//! Shaders of fullscreen and compute passes, and their pipelines.

mod cache;
mod shader;
mod validation;

pub(crate) use cache::{DepthTarget, PipelineCache, PipelineTargets};
pub(crate) use shader::ProgrammableStage;
pub use shader::{ComputeShader, FullscreenShader};
