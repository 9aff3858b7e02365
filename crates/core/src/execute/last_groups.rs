//! Bind groups found again without a search.

use super::bind::Bind;
use super::context::Resources;
use crate::declaration::Origin;
use crate::handle::Token;
use crate::pool::GroupKey;
use std::borrow::Borrow;
use std::ops::Range;
use std::sync::OnceLock;

/// So many groups are kept for a pass. One that binds more of them searches for those.
const KEPT: usize = 2;

/// By pass of a plan, the first groups that it bound. Only groups of what stays the same as long as the plan's objects
/// do, such as transient textures: that the tokens are the same is then all there is to compare.
pub(crate) struct LastGroups(Vec<[OnceLock<Box<Last>>; KEPT]>);

struct Last {
    layout: wgpu::BindGroupLayout,
    entries: Vec<Kept>,
    group: GroupKey,
}

/// What an entry was.
enum Kept {
    /// A transient texture or buffer: which of the frame's accesses.
    Token(u32),
    Range(u32, Range<u64>),
    Uniform(wgpu::Buffer, Range<u32>),
    Sampler(wgpu::Sampler),
}

impl LastGroups {
    pub(super) fn new(passes: usize) -> Self {
        Self((0..passes).map(|_| Default::default()).collect())
    }

    pub(super) fn get<'e>(
        &self,
        resources: &Resources<'_>,
        layout: &wgpu::BindGroupLayout,
        entries: impl ExactSizeIterator<Item: Borrow<Bind<'e>>> + Clone,
    ) -> Option<GroupKey> {
        let same = |last: &&Last| {
            last.layout == *layout
                && last.entries.len() == entries.len()
                && last
                    .entries
                    .iter()
                    .zip(entries.clone())
                    .all(|(kept, own)| kept.is(resources, own.borrow()))
        };
        let kept = self.0[resources.pass.index()].iter();
        kept.map_while(|kept| Some(&**kept.get()?)).find(same).map(|last| last.group)
    }

    pub(super) fn keep<'e>(
        &self,
        resources: &Resources<'_>,
        layout: &wgpu::BindGroupLayout,
        entries: impl Iterator<Item: Borrow<Bind<'e>>>,
        group: GroupKey,
    ) {
        let mut kept = self.0[resources.pass.index()].iter();
        if let Some(free) = kept.find(|kept| kept.get().is_none())
            && let Some(entries) = entries.map(|entry| Kept::of(resources, entry.borrow())).collect()
        {
            free.get_or_init(|| Box::new(Last { layout: layout.clone(), entries, group }));
        }
    }
}

impl Kept {
    /// `None` for what may be another object in the next frame, or belongs to the caller, who may drop it.
    fn of(resources: &Resources<'_>, entry: &Bind<'_>) -> Option<Self> {
        let transient = |token: Token| {
            let resource = resources.recording.plan.decl.resource(token.resource);
            (resource.origin == Origin::Transient).then_some(token.access)
        };
        match entry {
            Bind::Texture(token) | Bind::TextureArray(token) => transient(token.0).map(Self::Token),
            Bind::Buffer(token) => transient(token.0).map(Self::Token),
            Bind::BufferRange(token, range) => Some(Self::Range(transient(token.0)?, range.clone())),
            Bind::Uniform(uniform) => {
                let buffer = resources.recording.uniforms?.clone();
                Some(Self::Uniform(buffer, uniform.start..uniform.start + uniform.size))
            }
            Bind::Sampler(sampler) => Some(Self::Sampler((*sampler).clone())),
            Bind::ExternalView(_) | Bind::ExternalBuffer(_) => None,
        }
    }

    /// Whether an entry binds this. A token of another frame or pass is not the same.
    fn is(&self, resources: &Resources<'_>, entry: &Bind<'_>) -> bool {
        let recording = resources.recording;
        let same = |token: &Token, access: u32| token.frame == recording.frame && token.access == access;
        match (self, entry) {
            // Which of the two it is follows from the layout.
            (&Self::Token(access), Bind::Texture(token) | Bind::TextureArray(token)) => {
                same(&token.0, access)
            }
            (&Self::Token(access), Bind::Buffer(token)) => same(&token.0, access),
            (Self::Range(access, own), Bind::BufferRange(token, range)) => {
                same(&token.0, *access) && own == range
            }
            (Self::Uniform(buffer, own), Bind::Uniform(uniform)) => {
                uniform.frame == recording.frame
                    && recording.uniforms == Some(buffer)
                    && *own == (uniform.start..uniform.start + uniform.size)
            }
            (Self::Sampler(own), Bind::Sampler(sampler)) => own == *sampler,
            _ => false,
        }
    }
}
