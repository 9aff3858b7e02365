//! Bind groups by what they bind: the same views and buffers get the same group.

use std::collections::HashMap;
use std::num::NonZeroU64;

/// One bound object. Equality is identity of the wgpu object, so a group never outlives a change of slots.
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) enum Entry {
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
    Buffer { buffer: wgpu::Buffer, offset: u64, size: Option<NonZeroU64> },
}

struct Cached {
    group: wgpu::BindGroup,
    used: u64,
}

#[derive(Default)]
pub(crate) struct BindGroups {
    frame: u64,
    groups: HashMap<(wgpu::BindGroupLayout, Vec<Entry>), Cached>,
}

impl BindGroups {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(super) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.groups.retain(|_, cached| cached.used >= oldest);
    }

    /// Returns the group that binds `entries` to bindings 0, 1, 2 and so on.
    pub(crate) fn get(
        &mut self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        entries: Vec<Entry>,
    ) -> wgpu::BindGroup {
        let key = (layout.clone(), entries);
        if let Some(cached) = self.groups.get_mut(&key) {
            cached.used = self.frame;
            return cached.group.clone();
        }
        let group = create(device, layout, &key.1);
        self.groups.insert(key, Cached { group: group.clone(), used: self.frame });
        group
    }

    #[cfg(test)]
    pub(crate) fn len(&self) -> usize {
        self.groups.len()
    }
}

fn create(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, entries: &[Entry]) -> wgpu::BindGroup {
    let entries: Vec<_> = entries
        .iter()
        .enumerate()
        .map(|(binding, entry)| wgpu::BindGroupEntry {
            binding: binding as u32,
            resource: match entry {
                Entry::View(view) => wgpu::BindingResource::TextureView(view),
                Entry::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
                Entry::Buffer { buffer, offset, size } => {
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                        buffer,
                        offset: *offset,
                        size: *size,
                    })
                }
            },
        })
        .collect();
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}
