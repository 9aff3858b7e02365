//! Errors of ray scenes.

/// Errors of editing a [`RayScene`](super::RayScene) and of uploading it.
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
    /// A surface reads more channels than its texture has.
    #[error("a surface reads {needed} channels of a texture with {count}")]
    Channels {
        /// Number of channels that it reads.
        needed: usize,
        /// Number of channels of the texture.
        count: usize,
    },
    /// An instance has not as many surfaces as triangles.
    #[error("an instance has {count} surfaces for {triangles} triangles; expected one each")]
    Surfaces {
        /// Number of surfaces.
        count: usize,
        /// Number of triangles of its mesh.
        triangles: usize,
    },
    /// A key refers to something that was removed, or belongs to another scene.
    #[error("the key of a {what} of the ray scene is stale; it was removed, or is another scene's")]
    Stale {
        /// What it referred to, such as `mesh`.
        what: &'static str,
    },
    /// Something that is to be removed is still used.
    #[error("a {what} of the ray scene has {users} users; remove them first")]
    InUse {
        /// What was to be removed, such as `mesh`.
        what: &'static str,
        /// Number of its users.
        users: usize,
    },
    /// There are more elements than can be numbered.
    #[error("the ray scene cannot hold {count} more elements; at most 2^30 of each kind are allowed")]
    TooMany {
        /// Number of elements that do not fit.
        count: usize,
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
