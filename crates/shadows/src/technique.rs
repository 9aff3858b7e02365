//! The contract between shadow techniques and whoever lights a scene.

use shadowgraph_core::{Bind, Error as GraphError, Frame, Pass, Resources, ShaderPass};
use shadowgraph_core::{Buffer, BufferToken, Texture, TextureToken, Uniform};
use shadowgraph_shaders::ModuleSource;

use crate::{Error, Needs, ShadowInputs, Unshadowed};

/// A way of making shadows: nodes for the graph, and a WGSL module that answers "how much of this light arrives
/// here".
///
/// The first module has `#define_import_path shadowgraph::technique` and the functions
/// `shadow_visibility(light: u32, receiver: Receiver) -> vec3f` (1 lit, 0 in shadow) and
/// `shadow_debug_color(light: u32, receiver: Receiver) -> vec3f`. It is called in loops and from compute passes, so
/// it never uses implicit derivatives. All of bind group 1 is its own.
pub trait ShadowTechnique: Sync {
    /// Returns the name that users choose it by.
    fn name(&self) -> &str;

    /// Returns what it needs of shared services, with the settings in use.
    fn needs(&self, inputs: &ShadowInputs<'_>) -> Needs;

    /// Whether it reads the surfaces that the picture shows ([`Screen`]).
    fn reads_surfaces(&self) -> bool {
        false
    }

    /// Returns how many variants of its WGSL there are, at least 1. Variant 0 serves every frame; others have less in them,
    /// and [`ShadowOutputs::variant`] says which of them a frame is best lit with.
    fn variant_count(&self) -> u32 {
        1
    }

    /// Returns its WGSL modules in a variant: the one with the functions, and those that take the place of built-in ones.
    fn modules(&self, variant: u32) -> Vec<ModuleSource>;

    /// Returns what each binding of group 1 is, by number.
    fn binding_types(&self) -> Vec<wgpu::BindingType>;

    /// Returns the layout of bind group 1: that of [`binding_types`](Self::binding_types).
    fn bind_group_layout(&self) -> &wgpu::BindGroupLayout;

    /// Adds its passes to the frame. What is not needed (no shadowed light, no caster in reach) adds no pass.
    /// `screen` is there if [`reads_surfaces`](Self::reads_surfaces) says so.
    ///
    /// # Errors
    /// For settings, a camera or an aspect ratio that are out of range; [`Error::NoSurfaces`].
    fn add_to<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        inputs: &ShadowInputs<'f>,
        screen: Option<&Screen>,
    ) -> Result<ShadowOutputs<'f>, Error>;
}

/// What the picture shows, for techniques that ask for it.
#[derive(Clone, Debug)]
pub struct Screen {
    /// Width and height of the picture, pixels.
    pub size_px: [u32; 2],
    /// The camera: the storage buffer `view` of `shadowgraph::view`.
    pub view: Buffer,
    /// The lights: the storage buffer `lights` of `shadowgraph::view`.
    pub lights: Buffer,
    /// Where surfaces are and which way they face, those of all that is not blended: `Rgba32Float`, as
    /// `shadowgraph::surface` says.
    pub surfaces: Texture,
    /// Whether something is blended over the surfaces.
    pub has_blended: bool,
}

/// What a technique gives to the passes that light.
#[derive(Default)]
pub struct ShadowOutputs<'f> {
    /// Which variant of the technique's modules has all that this frame needs, and the least beyond; see
    /// [`ShadowTechnique::modules`].
    pub variant: u32,
    /// The light whose `shadow_debug_color` tells most: the main one, 0 where there is none.
    pub debug_light: u32,
    /// Bind group 1: its place in the list is the binding number.
    pub bindings: Vec<ShadowBinding<'f>>,
    /// Textures worth looking at, by name.
    pub debug: Vec<(&'static str, Texture)>,
    /// The lights that are to cast shadows but have none in this frame, and why.
    pub unshadowed: Vec<Unshadowed>,
}

/// One binding of group 1.
pub enum ShadowBinding<'f> {
    /// A storage buffer, read.
    Buffer(Buffer),
    /// A sampled texture.
    Texture(Texture),
    /// A sampled texture, as a 2D array.
    TextureArray(Texture),
    /// A storage buffer of the technique's own, read.
    OwnBuffer(&'f wgpu::Buffer),
    /// A sampler of the technique's.
    Sampler(&'f wgpu::Sampler),
    /// A uniform block of the frame.
    Uniform(Uniform),
}

/// The bindings of a pass that has declared to read them.
pub struct ShadowTokens<'f>(Vec<Token<'f>>);

enum Token<'f> {
    Buffer(BufferToken),
    Texture(TextureToken),
    TextureArray(TextureToken),
    OwnBuffer(&'f wgpu::Buffer),
    Sampler(&'f wgpu::Sampler),
    Uniform(Uniform),
}

impl Token<'_> {
    fn bind(&self) -> Bind<'_> {
        match self {
            Token::Buffer(buffer) => Bind::Buffer(*buffer),
            Token::Texture(texture) => Bind::Texture(*texture),
            Token::TextureArray(texture) => Bind::TextureArray(*texture),
            Token::OwnBuffer(buffer) => Bind::OwnBuffer(buffer),
            Token::Sampler(sampler) => Bind::Sampler(sampler),
            Token::Uniform(uniform) => Bind::Uniform(*uniform),
        }
    }
}

impl<'f> ShadowOutputs<'f> {
    /// Declares that `pass` reads the shadows; move what it returns into the pass's body.
    pub fn read_in<K: ShaderPass>(&self, pass: &mut Pass<'_, 'f, K>) -> ShadowTokens<'f> {
        let declare = |binding: &ShadowBinding<'f>| match binding {
            ShadowBinding::Buffer(buffer) => Token::Buffer(pass.storage_buffer(buffer)),
            ShadowBinding::Texture(texture) => Token::Texture(pass.sample(texture)),
            ShadowBinding::TextureArray(texture) => Token::TextureArray(pass.sample(texture)),
            ShadowBinding::OwnBuffer(buffer) => Token::OwnBuffer(buffer),
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
    /// If used in another pass than it was declared in.
    pub fn bind_group(
        &self,
        resources: &Resources<'_>,
        layout: &wgpu::BindGroupLayout,
    ) -> Result<wgpu::BindGroup, GraphError> {
        let entries: Vec<_> = self.0.iter().map(Token::bind).collect();
        resources.bind_group(layout, &entries)
    }
}
