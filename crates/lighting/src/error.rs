//! What can go wrong while pipelines are made.

/// Why lit passes could not be set up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The WGSL, that of the shadow technique included, does not go together.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
    /// The depth pipelines could not be made.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
}
