//! Errors of measurements.

use shadowgraph::ron_file::ParseError;

/// Error of a measurement. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A case, variant or bounds file is invalid.
    #[error(transparent)]
    File(#[from] ParseError),
    /// The images to compare are inconsistent.
    #[error(transparent)]
    Metrics(#[from] crate::metrics::MetricsError),
    /// The benchmark supports the output `color` only.
    #[error("the benchmark supports the output `color` only: the hand-written passes draw no other")]
    BenchAov,
    /// The GPU returned no data for a read-back.
    #[error("the GPU returned no data for a read-back")]
    MissingReadback,
    /// A view cannot be rendered.
    #[error(transparent)]
    Draw(#[from] shadowgraph::Error),
    /// A frame cannot be compiled or recorded.
    #[error(transparent)]
    Graph(#[from] shadowgraph_core::Error),
    /// A scene cannot be loaded or used.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
    /// A camera is invalid.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// Shadows cannot be planned.
    #[error(transparent)]
    Shadows(#[from] shadowgraph_shadows::Error),
    /// A lit pass cannot be created.
    #[error(transparent)]
    Lighting(#[from] shadowgraph_lighting::Error),
    /// A shader cannot be composed.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
}
