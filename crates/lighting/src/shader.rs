//! Shader modules, and what passes over the whole picture share.

use std::borrow::Cow;

use shadowgraph_core::FullscreenShader;
use shadowgraph_shaders::ModuleSource;

use crate::Error;

/// Composes a built-in file with these modules.
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

/// Composes a built-in file whose fragment shader `entry` is drawn over a target.
pub(crate) fn fullscreen(
    device: &wgpu::Device,
    file: &'static str,
    entry: &'static str,
) -> Result<FullscreenShader, Error> {
    let module = module(device, file, &[])?;
    Ok(FullscreenShader::module(file, &module).entry_point(entry))
}

/// A sampler that filters and ends at the edges.
pub(crate) fn linear(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("linear"),
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        ..Default::default()
    })
}
