//! What can go wrong while pipelines are made.

/// Why lit passes could not be set up.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The WGSL, that of the shadow technique included, does not go together.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
    /// Deferred lighting of several samples a pixel.
    #[error("--samples {samples}: deferred lighting has one sample a pixel")]
    Samples {
        /// How many were asked for.
        samples: u32,
    },
    /// The depth pipelines could not be made.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
}
