//! ShaderPasses of shaders as a frame declares them: flat, so that declaring allocates nothing.

use super::shader::Program;
use crate::desc::Format;
use crate::execute::Bind;
use crate::handle::{BufferToken, TextureToken, Uniform};
use arrayvec::ArrayVec;
use std::sync::Arc;

/// As many colour attachments as any device allows.
const COLORS: usize = 8;

/// All of a frame's calls.
#[derive(Default)]
pub(crate) struct ShaderPasses {
    all: Vec<Declared>,
    entries: Vec<Entry>,
}

/// One call.
pub(crate) struct Declared {
    pub(super) program: Arc<Program>,
    /// Which of the entries are bound.
    entries: (u32, u32),
    pub(super) work: Work,
}

#[allow(clippy::large_enum_variant, reason = "they lie in a vector that is reused; a box would allocate")]
pub(super) enum Work {
    /// One triangle.
    Draw(Attachments),
    /// This many workgroups.
    Dispatch([u32; 3]),
    /// As many as the buffer says at this offset in bytes.
    DispatchIndirect(BufferToken, u64),
}

/// What a pipeline draws into.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub(crate) struct Attachments {
    pub(super) colors: ArrayVec<(Format, Option<wgpu::BlendState>), COLORS>,
    pub(super) depth: Option<Depth>,
    pub(super) samples: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct Depth {
    pub(super) format: Format,
    pub(super) write: bool,
    pub(super) compare: wgpu::CompareFunction,
}

/// What is bound: [`Bind`] without a lifetime.
pub(super) enum Entry {
    Texture(TextureToken),
    Buffer(BufferToken),
    Uniform(Uniform),
    Sampler(wgpu::Sampler),
    View(wgpu::TextureView),
    ExternalBuffer(wgpu::Buffer),
}

impl Entry {
    fn bind(&self) -> Bind<'_> {
        match self {
            Self::Texture(token) => Bind::Texture(*token),
            Self::Buffer(token) => Bind::Buffer(*token),
            Self::Uniform(uniform) => Bind::Uniform(*uniform),
            Self::Sampler(sampler) => Bind::Sampler(sampler),
            Self::View(view) => Bind::ExternalView(view),
            Self::ExternalBuffer(buffer) => Bind::ExternalBuffer(buffer),
        }
    }
}

impl ShaderPasses {
    /// Begins a call and returns its number.
    pub(super) fn begin(&mut self, program: Arc<Program>, work: Work) -> u32 {
        let end = self.entries.len() as u32;
        self.all.push(Declared { program, entries: (end, end), work });
        self.all.len() as u32 - 1
    }

    /// Binds one more thing to the call begun last.
    pub(super) fn bind(&mut self, entry: Entry) {
        self.entries.push(entry);
        if let Some(last) = self.all.last_mut() {
            last.entries.1 = self.entries.len() as u32;
        }
    }

    /// What the call begun last does.
    pub(super) fn work(&mut self) -> Option<&mut Work> {
        self.all.last_mut().map(|last| &mut last.work)
    }

    pub(super) fn get(&self, call: u32) -> Option<&Declared> {
        self.all.get(call as usize)
    }

    pub(super) fn entries(&self, call: &Declared) -> impl ExactSizeIterator<Item = Bind<'_>> + Clone {
        let (start, end) = call.entries;
        self.entries[start as usize..end as usize].iter().map(Entry::bind)
    }

    /// Where the calls lie.
    #[cfg(test)]
    pub(super) fn address(&self) -> usize {
        self.all.as_ptr().addr()
    }

    pub(crate) fn emptied(mut self) -> Self {
        self.all.clear();
        self.entries.clear();
        self
    }
}
