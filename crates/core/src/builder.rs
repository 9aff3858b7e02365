//! Declaration of a pass. The kind of pass decides which accesses it can declare.

mod copy;
#[cfg(feature = "gpu")]
mod shader_pass;

#[cfg(feature = "gpu")]
pub use shader_pass::ShaderPassBuilder;

use crate::access::{Access, Contents};
#[cfg(feature = "gpu")]
use crate::context::{Body, BodyResult, ComputeContext, EncoderContext, RenderContext};
use crate::declaration::{NoteSubject, PassKind};
use crate::frame::Frame;
use crate::handle::{Buffer, BufferToken, PassId, Texture, TextureToken};
use crate::name::Name;
use crate::subresource::Subresource;
use std::marker::PhantomData;

/// Marks a [`Pass`] that draws.
pub enum Rendering {}
/// Marks a [`Pass`] that dispatches compute work.
pub enum Compute {}
/// Marks a [`Pass`] that copies.
pub enum Copying {}
/// Marks a [`Pass`] that records into the raw encoder.
pub enum Encoding {}

/// A pass being declared. `&handle` reads, `&mut handle` writes and moves the handle to its next version.
///
/// The pass belongs to the frame from the start; a render pass without a body clears its attachments.
pub struct Pass<'p, 'f, K> {
    pub(crate) frame: &'p mut Frame<'f>,
    pub(crate) id: PassId,
    /// Subresource of the next access.
    subresource: Option<Subresource>,
    /// Number of colour attachments declared so far.
    colors: u32,
    kind: PhantomData<K>,
}

impl<'f> Frame<'f> {
    /// Declares a pass that draws.
    #[track_caller]
    pub fn render_pass(&mut self, name: impl Name) -> Pass<'_, 'f, Rendering> {
        let id = self.add_pass(name, PassKind::Render);
        Pass::new(self, id)
    }

    /// Declares a pass that dispatches compute work.
    #[track_caller]
    pub fn compute_pass(&mut self, name: impl Name) -> Pass<'_, 'f, Compute> {
        let id = self.add_pass(name, PassKind::Compute);
        Pass::new(self, id)
    }

    /// Declares a pass that copies; the graph records the copies itself.
    #[track_caller]
    pub fn copy_pass(&mut self, name: impl Name) -> Pass<'_, 'f, Copying> {
        let id = self.add_pass(name, PassKind::Copy);
        Pass::new(self, id)
    }

    /// Declares a pass that records into the raw encoder: the escape hatch for everything that the graph does not support.
    #[track_caller]
    pub fn encoder_pass(&mut self, name: impl Name) -> Pass<'_, 'f, Encoding> {
        let id = self.add_pass(name, PassKind::Encoder);
        Pass::new(self, id)
    }
}

impl<'p, 'f, K> Pass<'p, 'f, K> {
    pub(crate) fn new(frame: &'p mut Frame<'f>, id: PassId) -> Self {
        Self { frame, id, subresource: None, colors: 0, kind: PhantomData }
    }

    /// Returns the pass's id in the plan.
    pub fn id(&self) -> PassId {
        self.id
    }

    /// Keeps the pass even if nothing needs what it writes, for effects that the graph cannot see.
    pub fn keep(&mut self) {
        self.frame.pass_mut(self.id).keep = true;
    }

    /// Adds a sentence to what plans say about the pass, such as why it is needed in this frame.
    pub fn note(&mut self, text: impl Name) {
        self.frame.add_note(NoteSubject::Pass(self.id), text);
    }

    /// Runs this pass after `other`, for shared effects that the graph cannot see. It does not keep `other`.
    ///
    /// ```
    /// let mut frame = shadowgraph_core::Frame::new();
    /// let mut first = frame.encoder_pass("first");
    /// first.keep();
    /// let first = first.id();
    /// let mut second = frame.encoder_pass("second");
    /// second.keep();
    /// second.after(first);
    /// # frame.compile()?;
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn after(&mut self, other: PassId) {
        self.frame.declare_after(self.id, other);
    }

    /// Narrows the next access to a subresource.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Frame, Subresource, TextureDesc};
    /// let mut frame = Frame::new();
    /// let mut cube = frame.create_texture("cube", TextureDesc::d2(64, 64, Format::Depth32Float).layers(6));
    /// for face in 0..6 {
    ///     let mut pass = frame.render_pass(format_args!("face {face}"));
    ///     pass.subresource(Subresource::FULL.layer(face)).depth(&mut cube, Contents::clear_depth(0.0));
    /// }
    /// frame.export_texture(&cube);
    /// let plan = frame.compile()?.into_plan();
    /// assert!(plan.dependencies().is_empty(), "faces do not order each other");
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn subresource(&mut self, subresource: Subresource) -> &mut Self {
        self.subresource = Some(subresource);
        self
    }

    fn read_texture(&mut self, texture: &Texture, access: Access) -> TextureToken {
        TextureToken(self.frame.declare_read(self.id, texture.0, access, &mut self.subresource))
    }

    fn read_buffer(&mut self, buffer: &Buffer, access: Access) -> BufferToken {
        BufferToken(self.frame.declare_read(self.id, buffer.0, access, &mut self.subresource))
    }

    fn write_texture(&mut self, texture: &mut Texture, access: Access, contents: Contents) -> TextureToken {
        TextureToken(self.frame.declare_write(
            self.id,
            &mut texture.0,
            access,
            contents,
            &mut self.subresource,
        ))
    }

    fn write_buffer(&mut self, buffer: &mut Buffer, access: Access, contents: Contents) -> BufferToken {
        BufferToken(self.frame.declare_write(self.id, &mut buffer.0, access, contents, &mut self.subresource))
    }
}

/// Passes with a body, whose shaders read and write resources.
pub trait ShaderPass {}
impl ShaderPass for Rendering {}
impl ShaderPass for Compute {}
impl ShaderPass for Encoding {}

impl<K: ShaderPass> Pass<'_, '_, K> {
    /// Samples or loads a texture in a shader.
    pub fn sample(&mut self, texture: &Texture) -> TextureToken {
        self.read_texture(texture, Access::Sampled)
    }

    /// Reads a storage texture in a shader.
    pub fn storage_texture(&mut self, texture: &Texture) -> TextureToken {
        self.read_texture(texture, Access::StorageRead)
    }

    /// Writes a storage texture in a shader.
    pub fn storage_texture_mut(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        self.write_texture(texture, Access::StorageWrite, contents)
    }

    /// Reads a storage buffer in a shader.
    pub fn storage_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::StorageRead)
    }

    /// Writes a storage buffer in a shader.
    pub fn storage_buffer_mut(&mut self, buffer: &mut Buffer, contents: Contents) -> BufferToken {
        self.write_buffer(buffer, Access::StorageWrite, contents)
    }

    /// Reads a uniform buffer in a shader.
    pub fn uniform_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::Uniform)
    }

    /// Reads the arguments of an indirect draw or dispatch.
    pub fn indirect_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::Indirect)
    }
}

impl Pass<'_, '_, Rendering> {
    /// Draws into a colour attachment. Attachments are numbered in order of declaration.
    pub fn color(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        let index = self.colors;
        self.colors += 1;
        self.write_texture(texture, Access::Color(index), contents)
    }

    /// Resolves the last declared colour attachment, which must be multisampled, into `texture` at the end of the pass.
    pub fn resolve(&mut self, texture: &mut Texture) -> TextureToken {
        let index = self.colors.saturating_sub(1);
        self.write_texture(texture, Access::Resolve(index), Contents::Overwrite)
    }

    /// Tests and writes a depth(-stencil) attachment.
    pub fn depth(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        self.write_texture(texture, Access::Depth, contents)
    }

    /// Tests against a depth(-stencil) attachment without writing it; the same pass may also sample it.
    pub fn depth_read(&mut self, texture: &Texture) -> TextureToken {
        self.read_texture(texture, Access::DepthRead)
    }

    /// Reads vertices.
    pub fn vertex_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::Vertex)
    }

    /// Reads indices.
    pub fn index_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::Index)
    }
}

impl Pass<'_, '_, Encoding> {
    /// Copies out of a texture with the raw encoder.
    pub fn copy_source(&mut self, texture: &Texture) -> TextureToken {
        self.read_texture(texture, Access::CopySource)
    }

    /// Copies into a texture with the raw encoder.
    pub fn copy_target(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        self.write_texture(texture, Access::CopyTarget, contents)
    }

    /// Copies out of a buffer with the raw encoder.
    pub fn copy_source_buffer(&mut self, buffer: &Buffer) -> BufferToken {
        self.read_buffer(buffer, Access::CopySource)
    }

    /// Copies into a buffer with the raw encoder.
    pub fn copy_target_buffer(&mut self, buffer: &mut Buffer, contents: Contents) -> BufferToken {
        self.write_buffer(buffer, Access::CopyTarget, contents)
    }

    /// Draws into a texture in your own render pass, begun on the raw encoder.
    pub fn attachment(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        self.write_texture(texture, Access::Color(0), contents)
    }
}

#[cfg(feature = "gpu")]
macro_rules! body {
    ($kind:ident, $context:ident, $constructor:ident) => {
        impl<'f> Pass<'_, 'f, $kind> {
            /// Sets the function that records the pass. It runs when the frame is executed, unless the pass is culled. It
            /// captures tokens and borrowed data by `move`, without an allocation up to 56 bytes (a token is 8);
            /// [`Resources::bind_group`](crate::Resources::bind_group) has an example.
            pub fn body(self, body: impl for<'a> FnOnce(&mut $context<'a>) -> BodyResult + Send + 'f) {
                self.frame.work.bodies[self.id.index()] = Body::$constructor(body);
            }
        }
    };
}

#[cfg(feature = "gpu")]
body!(Rendering, RenderContext, render);
#[cfg(feature = "gpu")]
body!(Compute, ComputeContext, compute);
#[cfg(feature = "gpu")]
body!(Encoding, EncoderContext, encoder);
