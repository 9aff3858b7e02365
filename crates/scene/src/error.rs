//! Errors of loading and uploading a scene.

use std::path::PathBuf;

/// An error of loading or uploading a scene. Every message is one line.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The file could not be read.
    #[error("{}: cannot be read: {source}", file.display())]
    Read {
        /// The file.
        file: PathBuf,
        /// The error of the operating system.
        source: std::io::Error,
    },
    /// The file contains something invalid or unsupported.
    #[error("{}: {location}: {reason}", file.display())]
    Invalid {
        /// The file.
        file: PathBuf,
        /// The location in the file: "mesh 3 primitive 0".
        location: String,
        /// The error, with the allowed range if there is one.
        reason: String,
    },
    /// The scene exceeds a limit of the adapter.
    #[error("{what}: {value} exceeds the adapter's {limit} of {max}")]
    Limit {
        /// The value that is too large: "image 3 \"bark\" width".
        what: String,
        /// The value.
        value: u64,
        /// The name of the limit in `wgpu::Limits`.
        limit: &'static str,
        /// The limit.
        max: u64,
    },
    /// A copy of a scene follows another scene than the one that it was created from.
    #[error("the scene is another one than was uploaded: a {what} that it refers to does not exist")]
    Inconsistent {
        /// The kind of value: "mesh".
        what: &'static str,
    },
    /// A shader of this crate could not be composed.
    #[error("shader {name}: {reason}")]
    Shader {
        /// The shader's file.
        name: String,
        /// The error of the composer.
        reason: String,
    },
}

#[cfg(feature = "gpu")]
impl Error {
    pub(crate) fn missing(what: &'static str) -> Self {
        Self::Inconsistent { what }
    }
}
