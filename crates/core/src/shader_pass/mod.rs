//! Shader passes as a frame declares them: in flat arrays, so that declaring allocates nothing.

use crate::handle::{Bind, BufferToken, TextureToken, Uniform};
use crate::pipeline::{PipelineTargets, ProgrammableStage};
use std::sync::Arc;

#[cfg(test)]
mod tests;

/// All shader passes of a frame.
#[derive(Default)]
pub(crate) struct ShaderPasses {
    all: Vec<ShaderPassDecl>,
    bindings: Vec<Binding>,
}

/// One shader pass.
pub(crate) struct ShaderPassDecl {
    pub(crate) stage: Arc<ProgrammableStage>,
    /// The range of its bindings.
    bindings: (u32, u32),
    pub(crate) command: Command,
}

#[allow(clippy::large_enum_variant, reason = "they lie in a vector that is reused; a box would allocate")]
pub(crate) enum Command {
    /// Draws one triangle.
    Draw(PipelineTargets),
    /// Dispatches this many workgroups.
    Dispatch([u32; 3]),
    /// Dispatches as many workgroups as the buffer holds at this offset in bytes.
    DispatchIndirect(BufferToken, u64),
}

/// A bound resource: [`Bind`] without a lifetime.
pub(crate) enum Binding {
    Texture(TextureToken),
    Buffer(BufferToken),
    Uniform(Uniform),
    Sampler(wgpu::Sampler),
    ExternalView(wgpu::TextureView),
    ExternalBuffer(wgpu::Buffer),
}

impl Binding {
    fn as_bind(&self) -> Bind<'_> {
        match self {
            Self::Texture(token) => Bind::Texture(*token),
            Self::Buffer(token) => Bind::Buffer(*token),
            Self::Uniform(uniform) => Bind::Uniform(*uniform),
            Self::Sampler(sampler) => Bind::Sampler(sampler),
            Self::ExternalView(view) => Bind::ExternalView(view),
            Self::ExternalBuffer(buffer) => Bind::ExternalBuffer(buffer),
        }
    }
}

impl ShaderPasses {
    /// Begins a shader pass and returns its index.
    pub(crate) fn begin(&mut self, stage: Arc<ProgrammableStage>, command: Command) -> u32 {
        let end = self.bindings.len() as u32;
        self.all.push(ShaderPassDecl { stage, bindings: (end, end), command });
        self.all.len() as u32 - 1
    }

    /// Adds a binding to the shader pass that was begun last.
    pub(crate) fn bind(&mut self, binding: Binding) {
        self.bindings.push(binding);
        if let Some(last) = self.all.last_mut() {
            last.bindings.1 = self.bindings.len() as u32;
        }
    }

    /// Returns the command of the shader pass that was begun last.
    pub(crate) fn last_command(&mut self) -> Option<&mut Command> {
        self.all.last_mut().map(|last| &mut last.command)
    }

    pub(crate) fn get(&self, index: u32) -> Option<&ShaderPassDecl> {
        self.all.get(index as usize)
    }

    pub(crate) fn bindings(&self, pass: &ShaderPassDecl) -> impl ExactSizeIterator<Item = Bind<'_>> + Clone {
        let (start, end) = pass.bindings;
        self.bindings[start as usize..end as usize].iter().map(Binding::as_bind)
    }

    /// Returns the address of the declarations.
    #[cfg(test)]
    pub(crate) fn address(&self) -> usize {
        self.all.as_ptr().addr()
    }

    /// Removes all declarations and keeps their memory.
    pub(crate) fn cleared(mut self) -> Self {
        self.all.clear();
        self.bindings.clear();
        self
    }
}

/// The source of a uniform binding: bytes, or a block that several passes share.
#[derive(Clone, Copy, Debug)]
pub enum UniformSource<'a> {
    /// Bytes for this pass only, in the shader's layout.
    Bytes(&'a [u8]),
    /// A block from [`Frame::uniform`](crate::Frame::uniform).
    Shared(Uniform),
}

impl<'a> From<&'a [u8]> for UniformSource<'a> {
    fn from(bytes: &'a [u8]) -> Self {
        Self::Bytes(bytes)
    }
}

impl<'a, const N: usize> From<&'a [u8; N]> for UniformSource<'a> {
    fn from(bytes: &'a [u8; N]) -> Self {
        Self::Bytes(bytes)
    }
}

impl<'a> From<&'a Vec<u8>> for UniformSource<'a> {
    fn from(bytes: &'a Vec<u8>) -> Self {
        Self::Bytes(bytes)
    }
}

impl From<Uniform> for UniformSource<'_> {
    fn from(uniform: Uniform) -> Self {
        Self::Shared(uniform)
    }
}
