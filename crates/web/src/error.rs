//! The errors of this crate.

/// An error, in one line.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// The browser has no WebGPU, or no adapter for it.
    #[error("this browser has no WebGPU: {0}")]
    NoWebGpu(String),
    /// A file could not be fetched.
    #[error("{url}: {reason}")]
    Fetch {
        /// The address of the file.
        url: String,
        /// What the browser says, or the status of the answer.
        reason: String,
    },
    /// The settings are not JSON, or not those of shadows.
    #[error("settings: {0}")]
    Settings(String),
    /// There is no image to read.
    #[error("the canvas cannot be read: {0}")]
    Pixels(String),
    /// An error of the scene's file.
    #[error(transparent)]
    Scene(#[from] shadowgraph::scene::Error),
    /// An edit that the scene refuses.
    #[error(transparent)]
    Edit(#[from] shadowgraph::scene::EditError),
    /// An error of a pipeline file.
    #[error(transparent)]
    Pipeline(#[from] shadowgraph::pipelines::PipelineError),
    /// An unknown technique, or a setting out of range.
    #[error(transparent)]
    Shadows(#[from] shadowgraph::shadows::Error),
    /// An error of the renderer.
    #[error(transparent)]
    Render(#[from] shadowgraph::Error),
}
