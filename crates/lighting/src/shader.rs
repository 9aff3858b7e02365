//! Creation of shader modules and of fullscreen shaders.

use std::borrow::Cow;

use shadowgraph_core::FullscreenShader;
use shadowgraph_shaders::{ModuleSource, builtin};

use crate::error::Error;

/// Composes a built-in shader with these modules.
pub(crate) fn module(
    device: &wgpu::Device,
    file: &'static str,
    modules: &[ModuleSource],
) -> Result<wgpu::ShaderModule, Error> {
    let module = shadowgraph_shaders::compose(file, modules)?;
    Ok(device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(file),
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    }))
}

/// Composes a built-in file with the fragment entry point `entry` into a shader for fullscreen passes.
///
/// # Errors
/// Never with the built-in WGSL.
pub fn fullscreen(
    device: &wgpu::Device,
    file: &'static str,
    entry: &'static str,
) -> Result<FullscreenShader, Error> {
    let module = module(device, file, &[])?;
    Ok(FullscreenShader::module(file, &module).entry_point(entry))
}

/// Composes a built-in file like [`fullscreen`], with a placeholder replaced.
pub(crate) fn fullscreen_with(
    device: &wgpu::Device,
    file: &'static str,
    entry: &'static str,
    (placeholder, value): (&str, &str),
) -> Result<FullscreenShader, Error> {
    let source = builtin(file).unwrap_or_else(|| ModuleSource::new(file, "")).with_value(placeholder, value);
    let module = shadowgraph_shaders::compose_source(&source, &[])?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(file),
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });
    Ok(FullscreenShader::module(file, &module).entry_point(entry))
}

/// Creates a sampler that filters linearly and clamps to the edge.
pub(crate) fn linear_sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("linear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}
