//! Errors of creating pipelines.

/// An error of creating lit passes.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The WGSL, including that of the shadow technique, does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
    /// Deferred lighting with several samples per pixel.
    #[error("deferred lighting supports 1 sample per pixel, not {samples}")]
    Samples {
        /// The requested samples per pixel.
        samples: u32,
    },
    /// The depth pipelines could not be created.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
}
