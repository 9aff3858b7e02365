//! Pipelines: scripts that wire nodes together, one call per step. Copy one and edit it.

mod forward;

pub use forward::forward;

use shadowgraph_core::Texture;
use shadowgraph_lighting::Ambience;
use shadowgraph_scene::gpu::DrawList;
use shadowgraph_shadows::Unshadowed;

use crate::ViewOptions;

/// One view of a frame.
pub struct View<'v> {
    /// Who looks, and how.
    pub options: &'v ViewOptions,
    /// What of the scene is seen.
    pub draws: DrawList,
    /// The light from all around, and the exposure.
    pub ambience: Ambience,
}

/// What a pipeline gives.
pub struct Output {
    /// Four bytes a pixel, as large as the view.
    pub picture: Texture,
    /// The lights that are to cast shadows but have none, and why.
    pub unshadowed: Vec<Unshadowed>,
}
