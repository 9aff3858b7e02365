//! The output of a technique, and the shape of a screen mask.

use shadowgraph_core::{Bind, Error as GraphError, Format, Pass, Resources, ShaderPass};
use shadowgraph_core::{Buffer, BufferToken, Texture, TextureToken, Uniform};
use shadowgraph_scene::Light;

use crate::select::Unshadowed;

/// The output of a technique, for the passes that light.
#[derive(Default)]
pub struct ShadowOutputs<'f> {
    /// The smallest variant of the technique's modules that this frame can use; see
    /// [`ShadowTechnique::modules`](super::ShadowTechnique::modules).
    pub variant: u32,
    /// The light to show with `shadow_debug_color`: the main one, or 0 if there is none.
    pub debug_light: u32,
    /// Bind group 1: the index in the list is the binding number.
    pub bindings: Vec<ShadowBinding<'f>>,
    /// The screen mask, if there is one: `Rgba8Unorm`, as large as the image, with a layer for each of the [masked
    /// lights](crate::masked_lights): the visibility of the light from each pixel's surface.
    pub mask: Option<Texture>,
    /// Textures for debugging, by name.
    pub debug: Vec<(&'static str, Texture)>,
    /// The buffers of the [`ShadowView`](crate::ShadowView)s and [`ShadowLight`](crate::ShadowLight)s of its maps; `None` for a
    /// technique without maps.
    pub map_buffers: Option<[Buffer; 2]>,
    /// The lights with `casts_shadow` that have no shadows in this frame, and why.
    pub unshadowed: Vec<Unshadowed>,
}

/// One binding of group 1.
pub enum ShadowBinding<'f> {
    /// A read-only storage buffer.
    Buffer(Buffer),
    /// A sampled texture.
    Texture(Texture),
    /// A sampled texture, as a 2D array.
    TextureArray(Texture),
    /// A read-only storage buffer that the technique owns.
    ExternalBuffer(&'f wgpu::Buffer),
    /// A sampler that the technique owns.
    Sampler(&'f wgpu::Sampler),
    /// A uniform block of the frame.
    Uniform(Uniform),
}

/// The bindings of a pass that has declared that it reads them.
pub struct ShadowTokens<'f>(Vec<Token<'f>>);

enum Token<'f> {
    Buffer(BufferToken),
    Texture(TextureToken),
    TextureArray(TextureToken),
    ExternalBuffer(&'f wgpu::Buffer),
    Sampler(&'f wgpu::Sampler),
    Uniform(Uniform),
}

impl Token<'_> {
    fn bind(&self) -> Bind<'_> {
        match self {
            Token::Buffer(buffer) => Bind::Buffer(*buffer),
            Token::Texture(texture) => Bind::Texture(*texture),
            Token::TextureArray(texture) => Bind::TextureArray(*texture),
            Token::ExternalBuffer(buffer) => Bind::ExternalBuffer(buffer),
            Token::Sampler(sampler) => Bind::Sampler(sampler),
            Token::Uniform(uniform) => Bind::Uniform(*uniform),
        }
    }
}

impl<'f> ShadowOutputs<'f> {
    /// Declares that `pass` reads the shadows. Move the returned tokens into the pass's body.
    pub fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, 'f, K>) -> ShadowTokens<'f> {
        let declare = |binding: &ShadowBinding<'f>| match binding {
            ShadowBinding::Buffer(buffer) => Token::Buffer(pass.storage_buffer(buffer)),
            ShadowBinding::Texture(texture) => Token::Texture(pass.sample(texture)),
            ShadowBinding::TextureArray(texture) => Token::TextureArray(pass.sample(texture)),
            ShadowBinding::ExternalBuffer(buffer) => Token::ExternalBuffer(buffer),
            ShadowBinding::Sampler(sampler) => Token::Sampler(sampler),
            ShadowBinding::Uniform(uniform) => Token::Uniform(*uniform),
        };
        ShadowTokens(self.bindings.iter().map(declare).collect())
    }
}

impl ShadowTokens<'_> {
    /// Returns bind group 1.
    ///
    /// # Errors
    /// If called in another pass than the one that declared the reads.
    pub fn bind_group(
        &self,
        resources: &Resources<'_>,
        layout: &wgpu::BindGroupLayout,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let entries: Vec<_> = self.0.iter().map(Token::bind).collect();
        resources.bind_group(layout, &entries)
    }
}

/// The format of a screen mask: visibility in red, green and blue.
pub(crate) const MASK_FORMAT: Format = Format::Rgba8Unorm;

/// Largest number of lights with a layer in a screen mask; shadows of further lights are evaluated at each lookup.
pub const MAX_MASK_LAYERS: usize = 16;

/// Returns the lights that have a layer, in the order of the layers: the first [`MAX_MASK_LAYERS`] that cast shadows, in the
/// scene's order (directional lights come first).
#[must_use]
pub fn masked_lights(lights: &[Light]) -> Vec<u32> {
    let casting = (0u32..).zip(lights).filter(|(_, light)| light.casts_shadow);
    casting.map(|(index, _)| index).take(MAX_MASK_LAYERS).collect()
}
