//! Debug colours over the final image.

use bytemuck::bytes_of;
use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::error::Error;
use crate::shader::fullscreen;

/// Debug colours over the final image.
pub struct Overlay {
    shader: FullscreenShader,
}

impl Overlay {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "post/overlay.wgsl", "fs_overlay")? })
    }

    /// Adds the pass that overwrites `target` with `image` and, blended over it, `colors`, which are display-referred. All
    /// three have the same size; `strength` is 0 to 1.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        [image, colors]: [&Texture; 2],
        target: &mut Texture,
        strength: f32,
    ) {
        let pass = frame.fullscreen("overlay", &self.shader).sample(image).sample(colors);
        pass.uniform(bytes_of(&strength)).draw(target);
    }
}
