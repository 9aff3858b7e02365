//! Tonemapping of scene-linear light.

use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::error::Error;
use crate::shader::fullscreen;

/// The filmic tonemap: one fullscreen pass into an sRGB target.
pub struct Tonemap {
    shader: FullscreenShader,
}

impl Tonemap {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "tonemap.wgsl", "fs_tonemap")? })
    }

    /// Adds the pass that overwrites `target`, which must have an sRGB format, with the tonemapped `light`. Both must have
    /// the same size.
    pub fn add_to(&self, frame: &mut Frame<'_>, light: &Texture, target: &mut Texture) {
        frame.fullscreen("tonemap", &self.shader).sample(light).draw(target);
    }
}
