//! Post-processing before and after tonemapping.

mod auto_exposure;
mod bloom;
mod fog;
mod fxaa;
mod occlusion;
mod overlay;
mod pyramid;
mod temporal;

pub use auto_exposure::{AutoExposure, AutoExposureSettings};
pub use bloom::Bloom;
pub use fog::{Fog, FogSettings};
pub use fxaa::Fxaa;
pub use occlusion::{Occlusion, OcclusionSettings};
pub use overlay::Overlay;
pub use pyramid::DepthPyramid;
pub use temporal::Temporal;

pub use crate::jitter::{Jitter, Jitters};
