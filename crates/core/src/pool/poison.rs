//! Objects that the pool keeps for the poison mode, which fills memory with conspicuous values.

use crate::desc::ResourceDesc;
use crate::plan::Slot;
use wgpu::{BufferUsages, TextureDimension, TextureUsages};

/// Fills buffers: NaN as `f32`, more than two billion as an integer.
const WORD: u32 = 0x7fcd_cdcd;
/// The smallest source buffer in bytes.
const MIN_BYTES: u64 = 1 << 20;

/// Returns the slot with the usages that filling it needs. Transient attachments cannot be filled: nothing outside their
/// render pass sees them, and inside it a clear replaces the fill.
pub(super) fn with_fill_usage(mut slot: Slot, features: wgpu::Features) -> Slot {
    match slot.desc {
        ResourceDesc::Buffer(_) => slot.buffer_usage |= BufferUsages::COPY_DST,
        ResourceDesc::Texture(_) if slot.texture_usage.contains(TextureUsages::TRANSIENT_ATTACHMENT) => {}
        ResourceDesc::Texture(desc) => {
            let drawn = desc.format.guaranteed_format_features(features).allowed_usages
                & TextureUsages::RENDER_ATTACHMENT;
            let flat = desc.dimension == TextureDimension::D1;
            slot.texture_usage |= if drawn.is_empty() || flat { TextureUsages::COPY_DST } else { drawn };
        }
    }
    slot
}

/// The buffer that others are filled from.
#[derive(Default)]
pub(crate) struct PoisonBuffer(Option<wgpu::Buffer>);

impl PoisonBuffer {
    /// Returns the buffer, grown to hold `bytes`.
    pub(crate) fn get(&mut self, device: &wgpu::Device, bytes: u64) -> wgpu::Buffer {
        if let Some(buffer) = self.0.as_ref().filter(|buffer| buffer.size() >= bytes) {
            return buffer.clone();
        }
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("poison"),
            size: bytes.next_power_of_two().max(MIN_BYTES),
            usage: BufferUsages::COPY_SRC,
            mapped_at_creation: true,
        });
        // Mapping fails only on a lost device, which wgpu reports to the caller.
        if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
            let words = WORD.to_ne_bytes().repeat(mapped.len() / 4);
            mapped.copy_from_slice(&words);
        }
        buffer.unmap();
        self.0 = Some(buffer.clone());
        buffer
    }
}
