//! Bind groups by what they bind: the same views and buffers get the same group.

use super::views::Purpose;
use crate::error::Error;
use crate::subresource::Subresource;
use rustc_hash::{FxHashMap, FxHasher};
use slotmap::{SlotMap, new_key_type};
use std::hash::{Hash, Hasher};
use std::num::NonZeroU64;

/// One bound object. Equality is identity of the wgpu object, which is never that of another, so a group is found
/// again exactly as long as what it binds is the same.
#[derive(PartialEq, Eq, Hash)]
pub(crate) enum Bound<'a> {
    /// A part of a texture of the graph; its view is looked up only to create a group.
    Texture(&'a wgpu::Texture, Subresource, Purpose),
    View(&'a wgpu::TextureView),
    Sampler(&'a wgpu::Sampler),
    Buffer(&'a wgpu::Buffer, u64, Option<NonZeroU64>),
}

/// What a group was created from.
enum Kept {
    Texture(wgpu::Texture, Subresource, Purpose),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
    Buffer(wgpu::Buffer, u64, Option<NonZeroU64>),
}

impl Kept {
    fn of(bound: &Bound<'_>) -> Self {
        match *bound {
            Bound::Texture(texture, part, purpose) => Self::Texture(texture.clone(), part, purpose),
            Bound::View(view) => Self::View(view.clone()),
            Bound::Sampler(sampler) => Self::Sampler(sampler.clone()),
            Bound::Buffer(buffer, offset, size) => Self::Buffer(buffer.clone(), offset, size),
        }
    }

    fn is(&self, bound: &Bound<'_>) -> bool {
        let own = match self {
            Self::Texture(texture, part, purpose) => Bound::Texture(texture, *part, *purpose),
            Self::View(view) => Bound::View(view),
            Self::Sampler(sampler) => Bound::Sampler(sampler),
            Self::Buffer(buffer, offset, size) => Bound::Buffer(buffer, *offset, *size),
        };
        own == *bound
    }
}

struct Cached {
    layout: wgpu::BindGroupLayout,
    entries: Vec<Kept>,
    group: wgpu::BindGroup,
    used: u64,
}

new_key_type! {
    /// A bind group among those of a graph.
    pub(crate) struct GroupKey;
}

/// Bind groups, by a hash of layout and entries; those that share one by chance lie in one list.
#[derive(Default)]
pub(crate) struct BindGroups {
    frame: u64,
    groups: SlotMap<GroupKey, Cached>,
    by_hash: FxHashMap<u64, Vec<GroupKey>>,
}

impl BindGroups {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(super) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        let before = self.groups.len();
        self.groups.retain(|_, cached| cached.used >= oldest);
        if self.groups.len() < before {
            let groups = &self.groups;
            self.by_hash.retain(|_, list| {
                list.retain(|&key| groups.contains_key(key));
                !list.is_empty()
            });
        }
    }

    /// Returns a group that was found before, if it is still there.
    pub(crate) fn again(&mut self, key: GroupKey) -> Option<wgpu::BindGroup> {
        let cached = self.groups.get_mut(key)?;
        cached.used = self.frame;
        Some(cached.group.clone())
    }

    /// Returns the group that binds `entries` to bindings 0, 1, 2 and so on; `create` is asked where there is none.
    pub(crate) fn get(
        &mut self,
        layout: &wgpu::BindGroupLayout,
        entries: &[Bound<'_>],
        create: impl FnOnce() -> Result<wgpu::BindGroup, Error>,
    ) -> Result<(GroupKey, wgpu::BindGroup), Error> {
        let mut hasher = FxHasher::default();
        layout.hash(&mut hasher);
        entries.hash(&mut hasher);
        let list = self.by_hash.entry(hasher.finish()).or_default();
        let groups = &mut self.groups;
        let same = |key: &GroupKey| {
            groups.get(*key).is_some_and(|cached| {
                cached.layout == *layout
                    && cached.entries.len() == entries.len()
                    && cached.entries.iter().zip(entries).all(|(kept, bound)| kept.is(bound))
            })
        };
        let found = list.iter().copied().find(same);
        if let Some(key) = found
            && let Some(cached) = groups.get_mut(key)
        {
            cached.used = self.frame;
            return Ok((key, cached.group.clone()));
        }
        let group = create()?;
        let entries = entries.iter().map(Kept::of).collect();
        let cached = Cached { layout: layout.clone(), entries, group: group.clone(), used: self.frame };
        let key = groups.insert(cached);
        list.push(key);
        Ok((key, group))
    }

    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.groups.len()
    }
}
