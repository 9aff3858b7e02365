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
    /// The system has no clock for the processor time of a thread.
    #[error("the processor time of the thread cannot be read: {0}")]
    Clock(std::io::Error),
    /// A view cannot be rendered.
    #[error(transparent)]
    Draw(#[from] shadowgraph::Error),
}

/// Errors of the crates below are those of [`shadowgraph::Error`], wherever they come from.
macro_rules! from_lower_crate {
    ($($error:ty),+) => {$(
        impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self::Draw(error.into())
            }
        }
    )+};
}

from_lower_crate!(
    shadowgraph_core::Error,
    shadowgraph_scene::Error,
    shadowgraph_scene::CameraError,
    shadowgraph_scene::EditError,
    shadowgraph_shadows::Error,
    shadowgraph_lighting::Error,
    shadowgraph_shaders::Error
);
