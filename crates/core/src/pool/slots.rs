//! The physical textures and buffers of slots.

use super::check_limit;
use crate::desc::{BufferDesc, ResourceDesc, TextureDesc};
use crate::device::create_checked;
use crate::error::Error;
use crate::plan::Slot;
use rustc_hash::FxHashMap;
use slotmap::{SlotMap, new_key_type};
use wgpu::{BufferUsages, TextureUsages};

new_key_type! {
    /// A physical texture or buffer of the pool.
    pub(crate) struct SlotKey;
}

/// The physical texture or buffer of a slot or an import.
#[derive(Clone, PartialEq, Eq)]
pub(crate) enum PhysicalResource {
    Texture(wgpu::Texture),
    Buffer(wgpu::Buffer),
}

struct PooledResource {
    desc: ResourceDesc,
    physical: PhysicalResource,
    used: u64,
}

/// Physical textures and buffers by shape.
#[derive(Default)]
pub(crate) struct Slots {
    all: SlotMap<SlotKey, PooledResource>,
    by_shape: FxHashMap<ResourceDesc, Vec<SlotKey>>,
}

impl Slots {
    /// Returns the bytes of all textures and buffers, without the driver's padding.
    pub(crate) fn bytes(&self) -> u64 {
        self.all.values().map(|pooled| pooled.desc.bytes()).sum()
    }

    /// Takes an object of the slot's shape that no other slot of this frame uses, or creates one.
    ///
    /// Slots are acquired in the same order every frame, so the same declaration gets the same textures.
    pub(crate) fn acquire(
        &mut self,
        device: &wgpu::Device,
        slot: &Slot,
        label: &str,
        frame: u64,
    ) -> Result<(SlotKey, PhysicalResource), Error> {
        let keys = self.by_shape.entry(slot.desc).or_default();
        let all = &mut self.all;
        let free = |key: &&SlotKey| {
            all.get(**key).is_some_and(|p| p.used < frame && is_compatible(&p.physical, slot))
        };
        if let Some(&key) = keys.iter().find(free)
            && let Some(pooled) = all.get_mut(key)
        {
            pooled.used = frame;
            return Ok((key, pooled.physical.clone()));
        }
        let physical = create(device, slot, label)?;
        let key = all.insert(PooledResource { desc: slot.desc, physical: physical.clone(), used: frame });
        keys.push(key);
        Ok((key, physical))
    }

    /// Marks the objects as used by this frame.
    pub(crate) fn touch(&mut self, keys: &[SlotKey], frame: u64) {
        for &key in keys {
            if let Some(pooled) = self.all.get_mut(key) {
                pooled.used = frame;
            }
        }
    }

    /// Drops what was last used before frame `oldest`, and returns whether there was any.
    pub(crate) fn drop_idle(&mut self, oldest: u64) -> bool {
        let before = self.all.len();
        self.all.retain(|_, pooled| pooled.used >= oldest);
        self.remove_dropped_keys(before)
    }

    /// Drops what frame `frame` does not use, the longest idle first, until at most `budget` bytes are held. Returns whether
    /// anything was dropped.
    pub(crate) fn drop_above(&mut self, budget: u64, frame: u64) -> bool {
        let before = self.all.len();
        let mut held = self.bytes();
        let mut idle: Vec<_> = self.all.iter().filter(|(_, p)| p.used < frame).collect();
        idle.sort_by_key(|(key, pooled)| (pooled.used, *key));
        let idle: Vec<_> = idle.into_iter().map(|(key, pooled)| (key, pooled.desc.bytes())).collect();
        for (key, bytes) in idle {
            if held <= budget {
                break;
            }
            self.all.remove(key);
            held -= bytes;
        }
        self.remove_dropped_keys(before)
    }

    fn remove_dropped_keys(&mut self, before: usize) -> bool {
        let dropped = self.all.len() < before;
        if dropped {
            let all = &self.all;
            self.by_shape.retain(|_, keys| {
                keys.retain(|&key| all.contains_key(key));
                !keys.is_empty()
            });
        }
        dropped
    }
}

/// Returns whether the object has the usages that the slot needs. Transient attachments have their own kind of memory.
fn is_compatible(physical: &PhysicalResource, slot: &Slot) -> bool {
    match physical {
        PhysicalResource::Texture(texture) => {
            let (has, needs) = (texture.usage(), slot.texture_usage);
            let transient = TextureUsages::TRANSIENT_ATTACHMENT;
            has.contains(needs) && has.contains(transient) == needs.contains(transient)
        }
        PhysicalResource::Buffer(buffer) => buffer.usage().contains(slot.buffer_usage),
    }
}

fn create(device: &wgpu::Device, slot: &Slot, label: &str) -> Result<PhysicalResource, Error> {
    match slot.desc {
        ResourceDesc::Texture(desc) => {
            Ok(PhysicalResource::Texture(create_texture(device, &desc, slot.texture_usage, label)?))
        }
        ResourceDesc::Buffer(desc) => {
            check_buffer(device, label, &desc, slot.buffer_usage)?;
            let desc = wgpu::BufferDescriptor {
                label: Some(label),
                size: desc.bytes,
                usage: slot.buffer_usage,
                mapped_at_creation: false,
            };
            Ok(PhysicalResource::Buffer(create_checked(device, label, desc.size, |device| {
                device.create_buffer(&desc)
            })?))
        }
    }
}

/// Creates a texture.
///
/// # Errors
/// When the device's limits, its memory or the format do not allow it.
pub(crate) fn create_texture(
    device: &wgpu::Device,
    desc: &TextureDesc,
    usage: TextureUsages,
    label: &str,
) -> Result<wgpu::Texture, Error> {
    // wgpu requires RENDER_ATTACHMENT of every multisampled texture, even of one that is only copied.
    let usage = if desc.samples > 1 { usage | TextureUsages::RENDER_ATTACHMENT } else { usage };
    check_texture(device, label, desc)?;
    check_format(device, label, desc, usage)?;
    let bytes = desc.bytes();
    let desc = wgpu::TextureDescriptor {
        label: Some(label),
        size: desc.size,
        mip_level_count: desc.mip_levels,
        sample_count: desc.samples,
        dimension: desc.dimension,
        format: desc.format,
        usage,
        view_formats: &[],
    };
    create_checked(device, label, bytes, |device| device.create_texture(&desc))
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
    check_limit(name, side_name, side, side_limit.into())?;
    check_limit(name, layer_name, layers, layer_limit.into())
}

/// Checks that the device supports these usages of the format. What it supports beyond WebGPU's guarantees, where that
/// feature was requested, only the adapter knows.
fn check_format(
    device: &wgpu::Device,
    name: &str,
    desc: &TextureDesc,
    usage: TextureUsages,
) -> Result<(), Error> {
    let features = device.features();
    let unsupported =
        |problem: String| Err(Error::FormatSupport { resource: name.into(), format: desc.format, problem });
    let missing = desc.format.required_features() - features;
    if !missing.is_empty() {
        return unsupported(format!(
            "supports only with the feature {missing:?}: request that feature, or use another format"
        ));
    }
    let specific = features.contains(wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES);
    if specific || desc.format.is_multi_planar_format() {
        return Ok(());
    }
    let supported = desc.format.guaranteed_format_features(features);
    let missing = usage - supported.allowed_usages - TextureUsages::TRANSIENT_ATTACHMENT;
    if !missing.is_empty() {
        return unsupported(format!(
            "does not support with the usage {missing:?}: use a format that supports it, such as {}",
            alternative(usage)
        ));
    }
    if !supported.flags.sample_count_supported(desc.samples) {
        let counts = supported.flags.supported_sample_counts();
        return unsupported(format!("does not support with {} samples: use one of {counts:?}", desc.samples));
    }
    Ok(())
}

/// Returns formats that every device supports with these usages.
fn alternative(usage: TextureUsages) -> &'static str {
    if usage.contains(TextureUsages::STORAGE_BINDING) {
        "Rgba8Unorm or R32Float"
    } else {
        "Rgba8Unorm or Rgba16Float"
    }
}

fn check_buffer(
    device: &wgpu::Device,
    name: &str,
    desc: &BufferDesc,
    usage: BufferUsages,
) -> Result<(), Error> {
    let limits = device.limits();
    check_limit(name, "max_buffer_size", desc.bytes, limits.max_buffer_size)?;
    if usage.contains(BufferUsages::STORAGE) {
        let allowed = limits.max_storage_buffer_binding_size;
        check_limit(name, "max_storage_buffer_binding_size", desc.bytes, allowed)?;
    }
    Ok(())
}
