//! Bind groups of the passes of a plan, found again without a search.

use super::bind_group_cache::GroupKey;
use crate::handle::PassId;
use std::ops::Range;
use std::sync::OnceLock;

/// Groups kept for each pass. A pass that binds more searches for the others.
const GROUPS_PER_PASS: usize = 2;

/// The first groups that each pass of a plan bound. Only groups whose objects stay the same as long as the plan's do, such
/// as transient textures: then it is enough to compare the tokens.
pub(crate) struct PassGroups(Vec<[OnceLock<Box<PassGroup>>; GROUPS_PER_PASS]>);

struct PassGroup {
    layout: wgpu::BindGroupLayout,
    entries: Vec<EntryKey>,
    group: wgpu::BindGroup,
    /// The group in the cache.
    key: GroupKey,
}

/// Identifies what an entry bound.
pub(crate) enum EntryKey {
    /// A transient texture or buffer, by the index of its access in the frame.
    Access(u32),
    AccessRange(u32, Range<u64>),
    Uniform(wgpu::Buffer, Range<u32>),
    Sampler(wgpu::Sampler),
}

impl PassGroups {
    pub(super) fn new(passes: usize) -> Self {
        Self((0..passes).map(|_| Default::default()).collect())
    }

    /// Returns a group of the pass with this layout whose entries are the `same`.
    pub(crate) fn find(
        &self,
        pass: PassId,
        layout: &wgpu::BindGroupLayout,
        same: impl Fn(&[EntryKey]) -> bool,
    ) -> Option<&wgpu::BindGroup> {
        let groups = self.0[pass.index()].iter();
        let mut kept = groups.map_while(|group| Some(&**group.get()?));
        kept.find(|group| group.layout == *layout && same(&group.entries)).map(|group| &group.group)
    }

    /// Returns the groups in the cache.
    pub(super) fn keys(&self) -> impl Iterator<Item = GroupKey> {
        self.0.iter().flatten().filter_map(|group| Some(group.get()?.key))
    }

    /// Keeps a group for the pass, if there is space and all of its entries have keys.
    pub(crate) fn insert(
        &self,
        pass: PassId,
        layout: &wgpu::BindGroupLayout,
        entries: impl FnOnce() -> Option<Vec<EntryKey>>,
        (key, group): (GroupKey, &wgpu::BindGroup),
    ) {
        let mut groups = self.0[pass.index()].iter();
        if let Some(free) = groups.find(|group| group.get().is_none())
            && let Some(entries) = entries()
        {
            let (layout, group) = (layout.clone(), group.clone());
            free.get_or_init(|| Box::new(PassGroup { layout, entries, group, key }));
        }
    }
}
