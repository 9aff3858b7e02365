//! Errors of ray scenes.

/// Errors of creating a [`RayScene`](super::RayScene) or a [`GpuRayScene`](super::GpuRayScene).
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The number of texels does not match the size of the channel, or is zero.
    #[error(
        "a texture channel of {width} x {height} texels has {bytes} bytes; expected one byte per texel, at least one"
    )]
    Texels {
        /// Width, texels.
        width: u32,
        /// Height, texels.
        height: u32,
        /// Number of bytes passed.
        bytes: usize,
    },
    /// An occluder refers to a channel that does not exist.
    #[error("occluder {occluder} refers to channel {texture}; the scene has {count} channels")]
    NoTexture {
        /// The occluder's index.
        occluder: usize,
        /// The channel that it refers to.
        texture: u32,
        /// Number of channels.
        count: usize,
    },
    /// There are more occluders than the tree can number.
    #[error("a ray scene of {count} triangles; at most {limit} are allowed")]
    TooMany {
        /// Number of triangles.
        count: usize,
        /// Largest allowed number.
        limit: usize,
    },
    /// A buffer of the GPU scene is larger than a binding can be.
    #[error(
        "the {what} of the ray scene need {bytes} bytes; a storage buffer binding is limited to {limit}: {help}"
    )]
    TooBig {
        /// Contents of the buffer, such as `triangles`.
        what: &'static str,
        /// Required size, bytes.
        bytes: u64,
        /// Largest allowed size, bytes.
        limit: u64,
        /// A way to fix it.
        help: &'static str,
    },
}
