//! A texture that frames copy for the CPU while they run.

use crate::plan::Plan;
use std::sync::Arc;

/// One version of a texture, to be copied in each frame: [`Graph::watch`](crate::Graph::watch).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WatchedTexture {
    /// The name of the texture or, where several have it, its [path](crate::Plan::resource_path).
    pub texture: String,
    /// The version, from 1; `None` for the last one of the frame.
    pub version: Option<u32>,
    /// The mip level.
    pub mip: u32,
    /// The layer.
    pub layer: u32,
}

impl WatchedTexture {
    /// Watches the last version of a texture, its first mip level and layer.
    pub fn last(texture: impl Into<String>) -> Self {
        Self { texture: texture.into(), version: None, mip: 0, layer: 0 }
    }
}

/// The plan of frames that copy a texture, and what it was made of.
pub(crate) struct WatchedPlan {
    pub(crate) plan: Arc<Plan>,
    pub(crate) watch: WatchedTexture,
    pub(crate) watching: Arc<Plan>,
}
