//! FXAA.

use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::error::Error;
use crate::shader::{fullscreen, linear_sampler};

/// Anti-aliasing of the final image (Lottes, "FXAA", 2009).
pub struct Fxaa {
    shader: FullscreenShader,
    linear: wgpu::Sampler,
}

impl Fxaa {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "post/fxaa.wgsl", "fs_fxaa")?, linear: linear_sampler(device) })
    }

    /// Adds the pass that overwrites `target` with the smoothed `image`, which has the same size.
    pub fn add_to(&self, frame: &mut Frame<'_>, image: &Texture, target: &mut Texture) {
        frame.fullscreen("fxaa", &self.shader).sample(image).sampler(&self.linear).draw(target);
    }
}
