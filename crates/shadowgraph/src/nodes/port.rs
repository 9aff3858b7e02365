//! Inputs and outputs of nodes.

use shadowgraph_core::{Buffer, Format, Texture};
use shadowgraph_lighting::{GBuffer, ViewBuffers};
use shadowgraph_shadows::{ShadowOutputs, SurfaceBuffers};

/// The kind of a port's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PortKind {
    /// A texture of the frame.
    Texture,
    /// A buffer of the frame.
    Buffer,
    /// The camera and the lights, as shaders read them.
    View,
    /// Positions and normals of the visible surfaces, for techniques that read them.
    Surfaces,
    /// Shadows, as lit passes read them.
    Shadows,
    /// The textures that deferred lighting reads.
    GBuffer,
}

impl PortKind {
    /// Returns the name of the kind.
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

/// Whether a port is always connected.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Presence {
    /// An input that must be connected; an output that is set in every frame.
    #[default]
    Required,
    /// An input that may be left unconnected; an output that is not set in every frame.
    Optional,
    /// An input that reads a texture of one texel of this colour if it is not connected.
    Placeholder([f64; 4]),
}

/// One input or output of a kind of node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    /// The name.
    pub name: &'static str,
    /// The kind of value.
    pub kind: PortKind,
    /// Describes the value in a phrase.
    pub about: &'static str,
    /// Format of a texture: of an output, or the only one that an input accepts; `None` for any.
    pub format: Option<Format>,
    /// Whether it is always connected.
    pub presence: Presence,
    /// Whether the node overwrites this input in place: other consumers read it before, and the node's first output replaces it.
    pub in_place: bool,
}

impl Port {
    /// Describes a required port.
    pub const fn new(name: &'static str, kind: PortKind, about: &'static str) -> Self {
        Self { name, kind, about, format: None, presence: Presence::Required, in_place: false }
    }

    /// Describes a texture.
    pub const fn texture(name: &'static str, about: &'static str) -> Self {
        Self::new(name, PortKind::Texture, about)
    }

    /// Sets the format of the texture.
    #[must_use]
    pub const fn with_format(self, format: Format) -> Self {
        Self { format: Some(format), ..self }
    }

    /// Makes the port optional.
    #[must_use]
    pub const fn optional(self) -> Self {
        Self { presence: Presence::Optional, ..self }
    }

    /// Declares that the node overwrites this input in place.
    #[must_use]
    pub const fn in_place(self) -> Self {
        Self { in_place: true, ..self }
    }

    /// Sets the colour of the texel that is read if the input is not connected.
    #[must_use]
    pub const fn or_placeholder(self, color: [f64; 4]) -> Self {
        Self { presence: Presence::Placeholder(color), ..self }
    }
}

/// The value of a port in a frame.
pub enum Value<'f> {
    /// A texture.
    Texture(Texture),
    /// A buffer.
    Buffer(Buffer),
    /// The camera and the lights.
    View(ViewBuffers),
    /// Positions and normals of the visible surfaces.
    Surfaces(SurfaceBuffers),
    /// Shadows.
    Shadows(ShadowOutputs<'f>),
    /// The textures that deferred lighting reads.
    GBuffer(GBuffer),
}

impl Value<'_> {
    /// Returns the kind of port that it fits.
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
    fn from(surfaces: SurfaceBuffers) -> Self {
        Self::Surfaces(surfaces)
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
