//! Errors of measuring.

use shadowgraph::ron_file::ParseError;

/// Why something could not be measured. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A file of cases, variants or bounds is wrong.
    #[error(transparent)]
    File(#[from] ParseError),
    /// Images that are compared do not fit together.
    #[error(transparent)]
    Metrics(#[from] crate::metrics::MetricsError),
    /// A renderer of another output than colour is timed.
    #[error("only the output `color` is timed: the passes encoded by hand draw nothing else")]
    BenchAov,
    /// The GPU returned no data for a read-back.
    #[error("the frame returned no data")]
    NothingRead,
    /// A view could not be drawn.
    #[error(transparent)]
    Draw(#[from] shadowgraph::Error),
    /// A frame does not compile or record.
    #[error(transparent)]
    Graph(#[from] shadowgraph_core::Error),
    /// A scene does not load or fit.
    #[error(transparent)]
    Scene(#[from] shadowgraph_scene::Error),
    /// A camera sees nothing.
    #[error(transparent)]
    Camera(#[from] shadowgraph_scene::CameraError),
    /// Shadows cannot be planned.
    #[error(transparent)]
    Shadows(#[from] shadowgraph_shadows::Error),
    /// A lit pass cannot be made.
    #[error(transparent)]
    Lighting(#[from] shadowgraph_lighting::Error),
    /// A shader does not compose.
    #[error(transparent)]
    Shader(#[from] shadowgraph_shaders::Error),
}
