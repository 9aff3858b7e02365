//! Post-processing before and after tonemapping.

mod bloom;
mod fog;
mod fxaa;
mod occlusion;
mod overlay;
mod pyramid;
mod sky;
mod temporal;

pub use bloom::Bloom;
pub use fog::{Fog, FogSettings};
pub use fxaa::Fxaa;
pub use occlusion::{Occlusion, OcclusionSettings};
pub use overlay::Overlay;
pub use pyramid::DepthPyramid;
pub use sky::{Sky, SkySettings};
pub use temporal::Temporal;

pub use crate::jitter::{Jitter, Jitters};
