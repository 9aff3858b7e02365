//! A pyramid of depth.

use shadowgraph_core::{Format, Frame, FullscreenShader, Subresource, Texture, TextureDesc};

use crate::Error;
use crate::shader::fullscreen;

/// Depth at half, a quarter and so on of its size, each texel the farthest of those below it: what lies behind a texel is hidden by
/// all that it stands for (Greene, Kass and Miller, "Hierarchical Z-Buffer Visibility", 1993).
pub struct DepthPyramid {
    begin: FullscreenShader,
    halve: FullscreenShader,
}

impl DepthPyramid {
    /// Composes the shaders.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            begin: fullscreen(device, "post/pyramid.wgsl", "fs_begin")?,
            halve: fullscreen(device, "post/pyramid_halve.wgsl", "fs_halve")?,
        })
    }

    /// Adds the passes, and returns a texture `R32Float` as large as `depth`, with all its mips down to one texel. `depth` is
    /// reversed and has one sample a pixel.
    pub fn add_to(&self, frame: &mut Frame<'_>, depth: &Texture) -> Texture {
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let levels = size.width.max(size.height).max(1).ilog2() + 1;
        let desc = TextureDesc::d2(size.width, size.height, Format::R32Float);
        let mut pyramid = frame.create_texture("depth pyramid", TextureDesc { mip_levels: levels, ..desc });
        let mip = |level| Subresource::FULL.mip(level);
        frame.fullscreen("level 0", &self.begin).sample(depth).subresource(mip(0)).draw(&mut pyramid);
        for level in 1..levels {
            let pass = frame.fullscreen(format_args!("level {level}"), &self.halve);
            pass.subresource(mip(level - 1)).sample(&pyramid).subresource(mip(level)).draw(&mut pyramid);
        }
        pyramid
    }
}
