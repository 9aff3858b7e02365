//! The physical textures and buffers of slots, kept from frame to frame.

mod bind_groups;

pub(crate) use bind_groups::{BindGroups, Entry};

use crate::desc::{BufferDesc, ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::plan::SlotPlan;
use slotmap::{SlotMap, new_key_type};
use std::collections::HashMap;

/// Frames that something may lie idle before it is dropped.
const IDLE_FRAMES: u64 = 8;

new_key_type! {
    struct TextureKey;
    struct BufferKey;
}

struct PooledTexture {
    desc: TextureDesc,
    texture: wgpu::Texture,
    used: u64,
}

struct PooledBuffer {
    desc: BufferDesc,
    buffer: wgpu::Buffer,
    used: u64,
}

struct CachedView {
    view: wgpu::TextureView,
    used: u64,
}

/// Physical textures and buffers, their views and bind groups, reused from frame to frame.
///
/// One pool serves one device. What is not used for eight frames is dropped.
#[derive(Default)]
pub struct Pool {
    frame: u64,
    textures: SlotMap<TextureKey, PooledTexture>,
    buffers: SlotMap<BufferKey, PooledBuffer>,
    views: HashMap<(wgpu::Texture, wgpu::TextureAspect), CachedView>,
    pub(crate) bind_groups: BindGroups,
}

/// What a slot or an import is made of.
#[derive(Clone)]
pub(crate) enum Physical {
    Texture(wgpu::Texture),
    Buffer(wgpu::Buffer),
}

impl Pool {
    /// Creates an empty pool.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the bytes of all textures and buffers it holds, without the driver's padding.
    pub fn bytes(&self) -> u64 {
        let textures = self.textures.values().map(|t| t.desc.bytes()).sum::<u64>();
        textures + self.buffers.values().map(|b| b.desc.bytes).sum::<u64>()
    }

    /// Starts a frame: everything is free again, and what has been idle for long goes.
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
        let oldest = self.frame.saturating_sub(IDLE_FRAMES);
        self.textures.retain(|_, texture| texture.used >= oldest);
        self.buffers.retain(|_, buffer| buffer.used >= oldest);
        self.views.retain(|_, view| view.used >= oldest);
        self.bind_groups.begin_frame(self.frame, oldest);
    }

    /// Returns something of the slot's shape that no other slot of this frame has.
    ///
    /// Slots ask in the same order every frame, so the same declaration gets the same textures.
    pub(crate) fn acquire(
        &mut self,
        device: &wgpu::Device,
        slot: &SlotPlan,
        label: &str,
    ) -> Result<Physical, Error> {
        match slot.desc {
            ResourceDesc::Texture(desc) => {
                let frame = self.frame;
                let fits = |t: &PooledTexture| {
                    t.used < frame && t.desc == desc && t.texture.usage().contains(slot.texture_usage)
                };
                if let Some(pooled) = self.textures.values_mut().find(|t| fits(t)) {
                    pooled.used = frame;
                    return Ok(Physical::Texture(pooled.texture.clone()));
                }
                check_texture(device, label, &desc)?;
                let texture = create_texture(device, slot, &desc, label);
                self.textures.insert(PooledTexture { desc, texture: texture.clone(), used: frame });
                Ok(Physical::Texture(texture))
            }
            ResourceDesc::Buffer(desc) => {
                let frame = self.frame;
                let fits = |b: &PooledBuffer| {
                    b.used < frame && b.desc == desc && b.buffer.usage().contains(slot.buffer_usage)
                };
                if let Some(pooled) = self.buffers.values_mut().find(|b| fits(b)) {
                    pooled.used = frame;
                    return Ok(Physical::Buffer(pooled.buffer.clone()));
                }
                check_buffer(device, label, &desc, slot.buffer_usage)?;
                let buffer = device.create_buffer(&wgpu::BufferDescriptor {
                    label: Some(label),
                    size: desc.bytes,
                    usage: slot.buffer_usage,
                    mapped_at_creation: false,
                });
                self.buffers.insert(PooledBuffer { desc, buffer: buffer.clone(), used: frame });
                Ok(Physical::Buffer(buffer))
            }
        }
    }

    /// Returns the whole-texture view of one aspect.
    pub(crate) fn view(&mut self, texture: &wgpu::Texture, aspect: wgpu::TextureAspect) -> wgpu::TextureView {
        let frame = self.frame;
        let cached = self.views.entry((texture.clone(), aspect)).or_insert_with(|| CachedView {
            view: texture.create_view(&wgpu::TextureViewDescriptor { aspect, ..Default::default() }),
            used: frame,
        });
        cached.used = frame;
        cached.view.clone()
    }
}

fn create_texture(device: &wgpu::Device, slot: &SlotPlan, desc: &TextureDesc, label: &str) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: desc.size,
        mip_level_count: desc.mip_levels,
        sample_count: desc.samples,
        dimension: desc.dimension,
        format: desc.format,
        usage: slot.texture_usage,
        view_formats: &[],
    })
}

fn check_texture(device: &wgpu::Device, name: &str, desc: &TextureDesc) -> Result<(), Error> {
    let limits = device.limits();
    let side = u64::from(desc.size.width.max(desc.size.height));
    let layers = u64::from(desc.size.depth_or_array_layers);
    let (side_limit, side_name, layer_limit, layer_name) = match desc.dimension {
        wgpu::TextureDimension::D1 => {
            (limits.max_texture_dimension_1d, "max_texture_dimension_1d", 1, "layers of a 1D texture")
        }
        wgpu::TextureDimension::D2 => (
            limits.max_texture_dimension_2d,
            "max_texture_dimension_2d",
            limits.max_texture_array_layers,
            "max_texture_array_layers",
        ),
        wgpu::TextureDimension::D3 => (
            limits.max_texture_dimension_3d,
            "max_texture_dimension_3d",
            limits.max_texture_dimension_3d,
            "max_texture_dimension_3d",
        ),
    };
    limit(name, side_name, side, side_limit.into())?;
    limit(name, layer_name, layers, layer_limit.into())
}

fn check_buffer(
    device: &wgpu::Device,
    name: &str,
    desc: &BufferDesc,
    usage: wgpu::BufferUsages,
) -> Result<(), Error> {
    let limits = device.limits();
    limit(name, "max_buffer_size", desc.bytes, limits.max_buffer_size)?;
    if usage.contains(wgpu::BufferUsages::STORAGE) {
        let allowed = limits.max_storage_buffer_binding_size;
        limit(name, "max_storage_buffer_binding_size", desc.bytes, allowed)?;
    }
    Ok(())
}

fn limit(name: &str, limit: &'static str, needed: u64, allowed: u64) -> Result<(), Error> {
    if needed <= allowed {
        return Ok(());
    }
    Err(Error::Limit { resource: name.into(), limit, needed, allowed })
}
