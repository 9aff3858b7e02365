//! Bind groups by what they bind: equal views and buffers get the same group.

use super::view_cache::ViewUsage;
use crate::error::Error;
use crate::subresource::Subresource;
use rustc_hash::{FxHashMap, FxHasher};
use slotmap::{SlotMap, new_key_type};
use std::hash::{Hash, Hasher};
use std::num::NonZeroU64;

/// One bound object. Equality is identity of the wgpu object, which is never reused, so a group is found again exactly
/// as long as it binds the same objects.
#[derive(PartialEq, Eq, Hash)]
pub(crate) enum BoundResource<'a> {
    /// A subresource of a texture of the graph; its view is looked up only to create a group.
    Texture(&'a wgpu::Texture, Subresource, ViewUsage),
    View(&'a wgpu::TextureView),
    Sampler(&'a wgpu::Sampler),
    Buffer(&'a wgpu::Buffer, u64, Option<NonZeroU64>),
}

/// A bound object that the cache owns.
enum OwnedResource {
    Texture(wgpu::Texture, Subresource, ViewUsage),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
    Buffer(wgpu::Buffer, u64, Option<NonZeroU64>),
}

impl OwnedResource {
    fn new(bound: &BoundResource<'_>) -> Self {
        match *bound {
            BoundResource::Texture(texture, part, purpose) => Self::Texture(texture.clone(), part, purpose),
            BoundResource::View(view) => Self::View(view.clone()),
            BoundResource::Sampler(sampler) => Self::Sampler(sampler.clone()),
            BoundResource::Buffer(buffer, offset, size) => Self::Buffer(buffer.clone(), offset, size),
        }
    }

    fn matches(&self, bound: &BoundResource<'_>) -> bool {
        let owned = match self {
            Self::Texture(texture, part, purpose) => BoundResource::Texture(texture, *part, *purpose),
            Self::View(view) => BoundResource::View(view),
            Self::Sampler(sampler) => BoundResource::Sampler(sampler),
            Self::Buffer(buffer, offset, size) => BoundResource::Buffer(buffer, *offset, *size),
        };
        owned == *bound
    }
}

struct Cached {
    layout: wgpu::BindGroupLayout,
    entries: Vec<OwnedResource>,
    group: wgpu::BindGroup,
    used: u64,
}

new_key_type! {
    /// A bind group of the cache.
    pub(crate) struct GroupKey;
}

/// Bind groups, by a hash of layout and entries; colliding ones share a list.
#[derive(Default)]
pub(crate) struct BindGroupCache {
    frame: u64,
    /// No group was last used before this frame.
    oldest_use: u64,
    groups: SlotMap<GroupKey, Cached>,
    by_hash: FxHashMap<u64, Vec<GroupKey>>,
}

impl BindGroupCache {
    /// Starts a frame and drops what was last used before frame `oldest`. `kept` are the groups that passes have kept, and
    /// the frames that used them last.
    pub(super) fn begin_frame(
        &mut self,
        frame: u64,
        oldest: u64,
        kept: impl Iterator<Item = (GroupKey, u64)>,
    ) {
        self.frame = frame;
        if self.oldest_use >= oldest {
            return;
        }
        for (key, used) in kept {
            if let Some(cached) = self.groups.get_mut(key) {
                cached.used = cached.used.max(used);
            }
        }
        let before = self.groups.len();
        self.groups.retain(|_, cached| cached.used >= oldest);
        self.oldest_use = self.groups.values().map(|cached| cached.used).min().unwrap_or(frame);
        if self.groups.len() < before {
            let groups = &self.groups;
            self.by_hash.retain(|_, list| {
                list.retain(|&key| groups.contains_key(key));
                !list.is_empty()
            });
        }
    }

    /// Returns the group that binds `entries` to bindings 0, 1, 2 and so on, or creates it.
    pub(crate) fn get_or_create(
        &mut self,
        layout: &wgpu::BindGroupLayout,
        entries: &[BoundResource<'_>],
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
                    && cached.entries.iter().zip(entries).all(|(owned, bound)| owned.matches(bound))
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
        let entries = entries.iter().map(OwnedResource::new).collect();
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
