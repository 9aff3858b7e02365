//! A hierarchical depth buffer.

use shadowgraph_core::{Format, Frame, FullscreenShader, Subresource, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::fullscreen;

/// A hierarchical depth buffer: mip levels in which each texel is the farthest depth of the texels below it, so that what
/// lies behind a texel is occluded in its whole area (Greene, Kass and Miller, "Hierarchical Z-Buffer Visibility", 1993).
pub struct DepthPyramid {
    copy: FullscreenShader,
    downsample: FullscreenShader,
}

impl DepthPyramid {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            copy: fullscreen(device, "post/pyramid.wgsl", "fs_begin")?,
            downsample: fullscreen(device, "post/pyramid_halve.wgsl", "fs_downsample")?,
        })
    }

    /// Adds the passes, and returns an `R32Float` texture of the size of `depth` with all mip levels down to one texel.
    /// `depth` is reversed and must have one sample per pixel.
    pub fn add_to(&self, frame: &mut Frame<'_>, depth: &Texture) -> Texture {
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let levels = size.width.max(size.height).max(1).ilog2() + 1;
        let desc = TextureDesc::d2(size.width, size.height, Format::R32Float);
        let mut pyramid = frame.create_texture("depth pyramid", TextureDesc { mip_levels: levels, ..desc });
        let mip = |level| Subresource::FULL.mip(level);
        frame.fullscreen("level 0", &self.copy).sample(depth).subresource(mip(0)).draw(&mut pyramid);
        for level in 1..levels {
            let pass = frame.fullscreen(format_args!("level {level}"), &self.downsample);
            pass.subresource(mip(level - 1)).sample(&pyramid).subresource(mip(level)).draw(&mut pyramid);
        }
        pyramid
    }
}
