//! Declaring one pass. Which accesses there are depends on the kind of pass.

use crate::access::{Access, Contents};
use crate::declaration::CopyOp;
use crate::frame::Frame;
use crate::handle::{Buffer, BufferToken, PassId, Texture, TextureToken};
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
    kind: PhantomData<K>,
}

impl<'p, 'f, K> Pass<'p, 'f, K> {
    pub(crate) fn new(frame: &'p mut Frame<'f>, id: PassId) -> Self {
        Self { frame, id, kind: PhantomData }
    }

    /// Returns the pass's id in the plan.
    pub fn id(&self) -> PassId {
        self.id
    }

    /// Keeps the pass even if nothing needs what it writes, for effects that the graph cannot see.
    pub fn keep(&mut self) {
        self.frame.pass_mut(self.id).keep = true;
    }

    fn read_texture(&mut self, texture: &Texture, access: Access) -> TextureToken {
        TextureToken(self.frame.declare_read(self.id, texture.0, access))
    }

    fn read_buffer(&mut self, buffer: &Buffer, access: Access) -> BufferToken {
        BufferToken(self.frame.declare_read(self.id, buffer.0, access))
    }

    fn write_texture(&mut self, texture: &mut Texture, access: Access, contents: Contents) -> TextureToken {
        TextureToken(self.frame.declare_write(self.id, &mut texture.0, access, contents))
    }

    fn write_buffer(&mut self, buffer: &mut Buffer, access: Access, contents: Contents) -> BufferToken {
        BufferToken(self.frame.declare_write(self.id, &mut buffer.0, access, contents))
    }
}

/// What shaders can read and write, in every pass with a body.
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
        let pass = self.frame.pass_mut(self.id);
        let index = pass.accesses.iter().filter(|a| matches!(a.access, Access::Color(_))).count() as u32;
        self.write_texture(texture, Access::Color(index), contents)
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

    /// Draws into a texture through a render pass of your own, begun on the raw encoder.
    pub fn attachment(&mut self, texture: &mut Texture, contents: Contents) -> TextureToken {
        self.write_texture(texture, Access::Color(0), contents)
    }
}

impl Pass<'_, '_, Copying> {
    /// Copies mip 0 of a texture, all layers, to another of the same size and format.
    pub fn texture(&mut self, source: &Texture, target: &mut Texture) -> &mut Self {
        self.read_texture(source, Access::CopySource);
        self.write_texture(target, Access::CopyTarget, Contents::Cover);
        self.op(CopyOp::TextureToTexture { source: source.id(), target: target.id() })
    }

    /// Copies the whole of a buffer to another of the same size.
    pub fn buffer(&mut self, source: &Buffer, target: &mut Buffer) -> &mut Self {
        self.read_buffer(source, Access::CopySource);
        self.write_buffer(target, Access::CopyTarget, Contents::Cover);
        self.op(CopyOp::BufferToBuffer { source: source.id(), target: target.id() })
    }

    /// Copies mip 0 of a single-layer texture to a buffer, each row padded to a multiple of 256 bytes: the way to
    /// read a picture back (import a mappable buffer).
    pub fn texture_to_buffer(&mut self, source: &Texture, target: &mut Buffer) -> &mut Self {
        self.read_texture(source, Access::CopySource);
        self.write_buffer(target, Access::CopyTarget, Contents::Cover);
        self.op(CopyOp::TextureToBuffer { source: source.id(), target: target.id() })
    }

    fn op(&mut self, op: CopyOp) -> &mut Self {
        self.frame.pass_mut(self.id).copies.push(op);
        self
    }
}
