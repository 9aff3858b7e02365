//! What can go wrong with a scene.

use std::path::PathBuf;

/// Why a scene could not be loaded or uploaded. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file could not be read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file holds something that is wrong or not supported.
    #[error("{}: {place}: {reason}", file.display())]
    Invalid {
        /// The file.
        file: PathBuf,
        /// Where in the file: "mesh 3 primitive 0".
        place: String,
        /// What is wrong there, with the allowed range if there is one.
        reason: String,
    },
    /// The scene needs more than the adapter allows.
    #[error("{what}: {value} is over the adapter's {limit} of {max}")]
    Limit {
        /// What is too large: "image 3 \"bark\" width".
        what: String,
        /// How large it is.
        value: u64,
        /// The name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// The limit.
        max: u64,
    },
    /// Parts of a scene made by code do not fit together.
    #[error("{what}: {reason}")]
    Inconsistent {
        /// Which part: "image 3 \"bark\"".
        what: String,
        /// What does not fit.
        reason: String,
    },
    /// A shader of this crate could not be composed.
    #[error("shader {name}: {reason}")]
    Shader {
        /// The shader's file.
        name: String,
        /// What the composer said.
        reason: String,
    },
}
