//! What nodes take and give.

use shadowgraph_core::{Buffer, Format, Texture};
use shadowgraph_lighting::{GBuffer, ViewBuffers};
use shadowgraph_shadows::{ShadowOutputs, SurfaceBuffers};

/// What a port hands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortKind {
    /// A texture of the frame.
    Texture,
    /// A buffer of the frame.
    Buffer,
    /// The camera and the lights, as shaders read them.
    View,
    /// The surfaces that the picture shows, for techniques that ask for them.
    Surfaces,
    /// Shadows, as lit passes read them.
    Shadows,
    /// The textures that deferred lighting reads.
    GBuffer,
}

impl PortKind {
    /// Returns it in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Texture => "texture",
            Self::Buffer => "buffer",
            Self::View => "view",
            Self::Surfaces => "surfaces",
            Self::Shadows => "shadows",
            Self::GBuffer => "G-buffer",
        }
    }
}

/// Whether a port has to be fed, or is always there.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Need {
    /// An input that has to be fed; an output that is always there.
    #[default]
    Required,
    /// An input that the node does without; an output that not every frame has.
    Optional,
    /// An input in whose place a texture of one texel of this colour is read.
    StandIn([f64; 4]),
}

/// One input or output of a kind of node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    /// What it is called.
    pub name: &'static str,
    /// What it hands on.
    pub kind: PortKind,
    /// What is in it, in a phrase.
    pub about: &'static str,
    /// Of a texture: the format that an output has, or the only one that an input takes; `None` for any.
    pub format: Option<Format>,
    /// Whether it has to be fed.
    pub need: Need,
    /// Whether the node draws over what it is fed: whoever else reads it does so before, and its output takes its place.
    pub taken: bool,
}

impl Port {
    /// Describes a port that has to be fed, or that is always there.
    pub const fn new(name: &'static str, kind: PortKind, about: &'static str) -> Self {
        Self { name, kind, about, format: None, need: Need::Required, taken: false }
    }

    /// Describes a texture.
    pub const fn texture(name: &'static str, about: &'static str) -> Self {
        Self::new(name, PortKind::Texture, about)
    }

    /// Says which format the texture has.
    #[must_use]
    pub const fn of(self, format: Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Says that it need not be there.
    #[must_use]
    pub const fn optional(self) -> Self {
        Self { need: Need::Optional, ..self }
    }

    /// Says that the node draws over what this input is fed.
    #[must_use]
    pub const fn taken(self) -> Self {
        Self { taken: true, ..self }
    }

    /// Says that a texel of this colour takes the place of what is not fed.
    #[must_use]
    pub const fn or_texel(self, color: [f64; 4]) -> Self {
        Self { need: Need::StandIn(color), ..self }
    }
}

/// What is in a port in a frame.
pub enum Value<'f> {
    /// A texture.
    Texture(Texture),
    /// A buffer.
    Buffer(Buffer),
    /// The camera and the lights.
    View(ViewBuffers),
    /// What the picture shows.
    Surfaces(SurfaceBuffers),
    /// Shadows.
    Shadows(ShadowOutputs<'f>),
    /// What deferred lighting reads.
    GBuffer(GBuffer),
}

impl Value<'_> {
    /// Returns what kind of port it fits.
    pub fn kind(&self) -> PortKind {
        match self {
            Self::Texture(_) => PortKind::Texture,
            Self::Buffer(_) => PortKind::Buffer,
            Self::View(_) => PortKind::View,
            Self::Surfaces(_) => PortKind::Surfaces,
            Self::Shadows(_) => PortKind::Shadows,
            Self::GBuffer(_) => PortKind::GBuffer,
        }
    }
}

impl From<Texture> for Value<'_> {
    fn from(texture: Texture) -> Self {
        Self::Texture(texture)
    }
}

impl From<Buffer> for Value<'_> {
    fn from(buffer: Buffer) -> Self {
        Self::Buffer(buffer)
    }
}

impl From<ViewBuffers> for Value<'_> {
    fn from(view: ViewBuffers) -> Self {
        Self::View(view)
    }
}

impl From<SurfaceBuffers> for Value<'_> {
    fn from(screen: SurfaceBuffers) -> Self {
        Self::Surfaces(screen)
    }
}

impl From<GBuffer> for Value<'_> {
    fn from(buffer: GBuffer) -> Self {
        Self::GBuffer(buffer)
    }
}

impl<'f> From<ShadowOutputs<'f>> for Value<'f> {
    fn from(shadows: ShadowOutputs<'f>) -> Self {
        Self::Shadows(shadows)
    }
}
