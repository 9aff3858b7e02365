//! What can go wrong with a scene of rays.

/// Why a [`RayScene`](super::RayScene) or its [GPU form](super::GpuRayScene) could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A channel's texels do not fill its size, or it has none.
    #[error(
        "a channel of a texture of {width} x {height} pixels has {bytes} bytes; it needs one a pixel, at least one"
    )]
    Texels {
        /// Its width, pixels.
        width: u32,
        /// Its height, pixels.
        height: u32,
        /// The bytes that were given.
        bytes: usize,
    },
    /// An occluder names a channel that was not given.
    #[error("occluder {occluder} reads channel {texture}, but there are {count}")]
    NoTexture {
        /// The occluder's index.
        occluder: usize,
        /// The channel it names.
        texture: u32,
        /// How many there are.
        count: usize,
    },
    /// There are more occluders than the tree can number.
    #[error("a ray scene of {count} triangles; at most {limit} are allowed")]
    TooMany {
        /// How many there are.
        count: usize,
        /// The most that are allowed.
        limit: usize,
    },
    /// A buffer of the GPU form is larger than a binding can be.
    #[error("the {what} of the ray scene need {bytes} bytes; a storage buffer binding holds {limit}: {help}")]
    TooBig {
        /// What the buffer holds, such as `triangles`.
        what: &'static str,
        /// The bytes it needs.
        bytes: u64,
        /// The bytes that are allowed.
        limit: u64,
        /// What can be done about it.
        help: &'static str,
    },
}
