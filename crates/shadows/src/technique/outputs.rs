//! The output of a technique.

use shadowgraph_core::{Bind, Error as GraphError, Pass, Resources, ShaderPass};
use shadowgraph_core::{Buffer, BufferToken, Texture, TextureToken, Uniform};

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
    /// The screen mask, if there is one: `Rgba8Unorm`, as large as the image, with the [layers](crate::MaskLayers) of the scene's lights and
    /// `colored_lights`: the visibility of each light from each pixel's surface.
    pub mask: Option<Texture>,
    /// The lights whose visibility may differ between red, green and blue, ascending; those of others can share a layer of a screen mask.
    pub colored_lights: Vec<u32>,
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
    /// A buffer as a uniform block.
    UniformBuffer(Buffer),
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
            ShadowBinding::UniformBuffer(buffer) => Token::Buffer(pass.uniform_buffer(buffer)),
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
