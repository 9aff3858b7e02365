//! Shaders of passes that draw over the whole picture.

use std::borrow::Cow;

use shadowgraph_core::FullscreenShader;

use crate::Error;

/// Composes a built-in file whose fragment shader `entry` is drawn over a target.
pub(crate) fn fullscreen(
    device: &wgpu::Device,
    file: &'static str,
    entry: &'static str,
) -> Result<FullscreenShader, Error> {
    let module = shadowgraph_shaders::compose(file, &[])?;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(file),
        source: wgpu::ShaderSource::Naga(Cow::Owned(module)),
    });
    Ok(FullscreenShader::module(file, &module).entry(entry))
}
