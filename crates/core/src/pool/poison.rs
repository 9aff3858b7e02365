//! Objects that the pool keeps for the poison mode, which fills memory with conspicuous values.

use crate::access::ClearValue;
use crate::desc::{Format, ResourceDesc};
use crate::plan::Slot;
use wgpu::{BufferUsages, TextureDimension, TextureSampleType, TextureUsages};

/// Fills buffers: NaN as `f32`, more than two billion as an integer.
const WORD: u32 = 0x7fcd_cdcd;
/// The smallest source buffer in bytes.
const MIN_BYTES: u64 = 1 << 20;

/// Returns the fill value of a format: NaN for floats, the largest or -1 for integers, otherwise an unusual magenta; for
/// depth and stencil a value in between.
pub(crate) fn poison_value(format: Format) -> ClearValue {
    use wgpu::TextureFormat::{
        R16Float, R32Float, Rg11b10Ufloat, Rg16Float, Rg32Float, Rgba16Float, Rgba32Float,
    };
    if format.is_depth_stencil_format() {
        return ClearValue::DepthStencil(0.53, 0xcd);
    }
    ClearValue::Color(match (format, format.sample_type(None, None)) {
        (Format::Rgb10a2Uint, _) => [1023.0, 1023.0, 1023.0, 3.0],
        (_, Some(TextureSampleType::Uint)) => {
            let bits = 8 * format.block_copy_size(None).unwrap_or(4) / u32::from(format.components());
            [2f64.powi(bits as i32) - 1.0; 4]
        }
        (_, Some(TextureSampleType::Sint)) => [-1.0; 4],
        (R16Float | R32Float | Rg11b10Ufloat | Rg16Float | Rg32Float | Rgba16Float | Rgba32Float, _) => {
            [f64::NAN; 4]
        }
        _ => [0.93, 0.07, 0.93, 0.53],
    })
}

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
