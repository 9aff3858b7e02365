//! Identifiers: handles outside a pass, tokens inside one, ids in the plan.

use serde::Serialize;

macro_rules! id {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
        pub struct $name(pub(crate) u32);

        impl $name {
            /// Returns the index in the plan's list of this kind.
            pub fn index(self) -> usize {
                self.0 as usize
            }
        }
    };
}

id!(
    /// A pass, in order of declaration: indexes [`Plan::passes`](crate::Plan::passes).
    PassId
);
id!(
    /// A texture or buffer, in order of declaration: indexes [`Plan::resources`](crate::Plan::resources).
    ResourceId
);
id!(
    /// A node, in order of declaration: indexes [`Plan::nodes`](crate::Plan::nodes).
    NodeId
);
id!(
    /// A physical texture or buffer that resources share: indexes [`Plan::slots`](crate::Plan::slots).
    SlotId
);

/// One version of a resource of one frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Version {
    pub(crate) frame: u64,
    pub(crate) resource: ResourceId,
    pub(crate) version: u32,
}

/// A texture of a frame, at one version of its contents.
///
/// A clone from before a write is stale, and using it afterwards is an error.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texture(pub(crate) Version);

/// A buffer of a frame, at one version of its contents. See [`Texture`] for clones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Buffer(pub(crate) Version);

impl Texture {
    /// Returns the resource's id in the plan.
    pub fn id(&self) -> ResourceId {
        self.0.resource
    }
}

impl Buffer {
    /// Returns the resource's id in the plan.
    pub fn id(&self) -> ResourceId {
        self.0.resource
    }
}

/// Identifies an access of a pass to a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Token {
    /// The lower half of the frame's number.
    frame: u32,
    /// Index of the access in the frame; it determines the pass, the resource and the subresource.
    pub(crate) access: u32,
}

impl Token {
    pub(crate) fn new(frame: u64, access: u32) -> Self {
        Self { frame: frame as u32, access }
    }

    /// Returns whether the token is of this frame.
    #[cfg(any(feature = "gpu", test))]
    pub(crate) fn is_of(self, frame: u64) -> bool {
        self.frame == frame as u32
    }
}

/// A declared access to a texture, for the body of the pass that declared it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureToken(pub(crate) Token);

/// A declared access to a buffer, for the body of the pass that declared it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BufferToken(pub(crate) Token);

/// An exported texture, to get it from the executed frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TextureExport(pub(crate) Version);

/// An exported buffer, to get it from the executed frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BufferExport(pub(crate) Version);

/// A uniform block of a frame, for `Bind::Uniform`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Uniform {
    pub(crate) frame: u64,
    pub(crate) start: u32,
    pub(crate) size: u32,
}

impl Uniform {
    /// Returns the size of the block in bytes.
    pub fn size_bytes(&self) -> u32 {
        self.size
    }
}

/// One entry of a bind group; its index in the list is its binding number.
#[cfg(feature = "gpu")]
pub enum Bind<'a> {
    /// The declared part of a texture: one layer as 2D, several as a 2D array.
    Texture(TextureToken),
    /// The declared part of a texture as a 2D array, even for one layer: for shaders that take any number of layers.
    TextureArray(TextureToken),
    /// The declared part of a buffer.
    Buffer(BufferToken),
    /// A range of a buffer, in bytes; with a dynamic offset, the range at offset 0.
    BufferRange(BufferToken, std::ops::Range<u64>),
    /// A uniform block of this frame.
    Uniform(Uniform),
    /// A sampler.
    Sampler(&'a wgpu::Sampler),
    /// A view of a texture that is not part of the graph.
    ExternalView(&'a wgpu::TextureView),
    /// A buffer that is not part of the graph.
    ExternalBuffer(&'a wgpu::Buffer),
}
