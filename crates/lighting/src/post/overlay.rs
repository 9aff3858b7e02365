//! Colours over a finished picture.

use bytemuck::bytes_of;
use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::Error;
use crate::shader::fullscreen;

/// Colours over a finished picture, to debug by.
pub struct Overlay {
    shader: FullscreenShader,
}

impl Overlay {
    /// Composes the shader.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "post/overlay.wgsl", "fs_overlay")? })
    }

    /// Adds the pass that covers `target` with `picture` and `colors` over it, which are stored as they are to be seen. All are as
    /// large as each other; `strength` is 0 to 1.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        [picture, colors]: [&Texture; 2],
        target: &mut Texture,
        strength: f32,
    ) {
        let pass = frame.fullscreen("overlay", &self.shader).sample(picture).sample(colors);
        pass.uniform(bytes_of(&strength)).draw(target);
    }
}
