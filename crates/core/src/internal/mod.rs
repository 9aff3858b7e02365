//! Draws of the graph itself, for what wgpu has no command for: clearing a region of an attachment, and resampling the
//! contents of a texture into one of another size; and checks of values.

mod region_clear;
mod resample;
#[cfg(test)]
mod tests;
mod value_check;

pub(crate) use region_clear::{RegionClear, RegionClears, Targets};
#[cfg(test)]
use resample::ResampleError;
pub(crate) use resample::{Resampler, can_resample};
pub(crate) use value_check::{COUNT_WORDS, ImageKind, ImagePart, TEXEL_WORDS, ValueChecks, ValueStep};

const SOURCE: &str = include_str!("internal.wgsl");

/// Returns the section of the shader source that begins with the line `//: name`.
fn section(name: &str) -> &'static str {
    SOURCE.split("//: ").find_map(|section| section.strip_prefix(name)).unwrap_or_default()
}

/// Returns the scalar type of a format's components in WGSL.
fn scalar(sample_type: wgpu::TextureSampleType) -> &'static str {
    match sample_type {
        wgpu::TextureSampleType::Uint => "u32",
        wgpu::TextureSampleType::Sint => "i32",
        wgpu::TextureSampleType::Float { .. } | wgpu::TextureSampleType::Depth => "f32",
    }
}

/// Compiles a fragment stage with the shared vertex stage.
fn module(device: &wgpu::Device, label: &str, fragment: &str) -> wgpu::ShaderModule {
    let source = [section("fullscreen"), fragment].concat();
    device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(label),
        source: wgpu::ShaderSource::Wgsl(source.into()),
    })
}

/// Compiles the vertex stage of fullscreen passes, which outputs `uv`.
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

/// Creates a uniform buffer with these contents. They are written through mapping, since no queue is available.
fn uniform(device: &wgpu::Device, label: &str, words: &[u32]) -> wgpu::Buffer {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some(label),
        size: bytes.len() as u64,
        usage: wgpu::BufferUsages::UNIFORM,
        mapped_at_creation: true,
    });
    // Mapping fails only on a lost device, which wgpu reports to the caller.
    if let Ok(mut mapped) = buffer.get_mapped_range_mut(..) {
        mapped.copy_from_slice(&bytes);
    }
    buffer.unmap();
    buffer
}
