//! The graph's own few draws, for what wgpu has no command for: clearing a part of an attachment, and carrying the
//! contents of a texture over to one of another size.

mod region_clear;
mod resample;
#[cfg(test)]
mod tests;

pub(crate) use region_clear::{RegionClear, RegionClears, Targets};
#[cfg(test)]
use resample::ResampleError;
pub(crate) use resample::{Resampler, can_resample};

const TEXT: &str = include_str!("internal.wgsl");

/// Returns the part of the shader text that begins with the line `//: name`.
fn section(name: &str) -> &'static str {
    TEXT.split("//: ").find_map(|section| section.strip_prefix(name)).unwrap_or_default()
}

/// Returns what WGSL calls the components of such a format.
fn scalar(class: wgpu::TextureSampleType) -> &'static str {
    match class {
        wgpu::TextureSampleType::Uint => "u32",
        wgpu::TextureSampleType::Sint => "i32",
        wgpu::TextureSampleType::Float { .. } | wgpu::TextureSampleType::Depth => "f32",
    }
}

/// Compiles a fragment stage together with the vertex stage that all draws share.
fn module(device: &wgpu::Device, label: &str, fragment: &str) -> wgpu::ShaderModule {
    let text = [section("fullscreen"), fragment].concat();
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    })
}

/// Compiles the vertex stage of fullscreen passes, which gives `uv`.
pub(crate) fn fullscreen(device: &wgpu::Device) -> wgpu::ShaderModule {
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("fullscreen"),
        source: wgpu::ShaderSource::Wgsl(section("uv").into()),
    })
}

/// Returns the shared vertex stage of a module.
pub(crate) fn vertex(module: &wgpu::ShaderModule) -> wgpu::VertexState<'_> {
    wgpu::VertexState { module, entry_point: None, compilation_options: Default::default(), buffers: &[] }
}

/// Creates a uniform buffer that holds `words` from the start: without a queue, nothing can be written later.
fn uniform(device: &wgpu::Device, label: &str, words: &[u32]) -> wgpu::Buffer {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM,
        mapped_at_creation: true,
    });
    // It fails only with a lost device, of which wgpu tells the caller.
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.copy_from_slice(&bytes);
    }
    buffer.unmap();
    buffer
}
