//! Smooth edges of a finished picture.

use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::Error;
use crate::shader::{fullscreen, linear};

/// Edges of a finished picture, smoothed by what the picture shows (Lottes, "FXAA", 2009).
pub struct Fxaa {
    shader: FullscreenShader,
    linear: wgpu::Sampler,
}

impl Fxaa {
    /// Composes the shader.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "post/fxaa.wgsl", "fs_fxaa")?, linear: linear(device) })
    }

    /// Adds the pass that covers `target` with `picture`, which is as large.
    pub fn add_to(&self, frame: &mut Frame<'_>, picture: &Texture, target: &mut Texture) {
        frame.fullscreen("fxaa", &self.shader).sample(picture).sampler(&self.linear).draw(target);
    }
}
