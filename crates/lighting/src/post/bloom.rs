//! Bloom.

use bytemuck::bytes_of;
use shadowgraph_core::{Format, Frame, FullscreenShader, Subresource, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::{fullscreen, linear_sampler};

/// Bloom: the light is downsampled level by level, and summed while it is upsampled again (Jimenez, "Next Generation Post
/// Processing in Call of Duty: Advanced Warfare", 2014).
pub struct Bloom {
    first_downsample: FullscreenShader,
    downsample: FullscreenShader,
    upsample: FullscreenShader,
    mix: FullscreenShader,
    linear: wgpu::Sampler,
}

impl Bloom {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = |entry| fullscreen(device, "post/bloom.wgsl", entry);
        Ok(Self {
            first_downsample: shader("fs_first")?,
            downsample: shader("fs_downsample")?,
            upsample: shader("fs_upsample")?,
            mix: fullscreen(device, "post/bloom_mix.wgsl", "fs_mix")?,
            linear: linear_sampler(device),
        })
    }

    /// Adds the passes that overwrite `target`, which has the size of `light`, with the light and its bloom. `strength` is the
    /// fraction of light that spreads, 0 to 1; `levels` is the number of downsampled levels, 1 to 10: each doubles the
    /// radius.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        light: &Texture,
        target: &mut Texture,
        strength: f32,
        levels: u32,
    ) {
        let size = frame.texture_desc(light).map(|desc| desc.size).unwrap_or_default();
        let half = TextureDesc::d2((size.width / 2).max(1), (size.height / 2).max(1), Format::Rgba16Float);
        let max_levels = half.size.width.max(half.size.height).ilog2() + 1;
        let levels = levels.clamp(1, max_levels);
        let mip = |level| Subresource::FULL.mip(level);
        let mut down = frame.create_texture("halved", TextureDesc { mip_levels: levels, ..half });
        let pass = frame.fullscreen("halve 1", &self.first_downsample).sample(light).sampler(&self.linear);
        pass.subresource(mip(0)).draw(&mut down);
        for level in 1..levels {
            let pass = frame.fullscreen(format_args!("halve {}", level + 1), &self.downsample);
            let pass = pass.subresource(mip(level - 1)).sample(&down).sampler(&self.linear);
            pass.subresource(mip(level)).draw(&mut down);
        }
        let (mut spread, mut top) = (down.clone(), levels - 1);
        if levels > 1 {
            let mut up = frame.create_texture("spread", TextureDesc { mip_levels: levels - 1, ..half });
            for level in (0..levels - 1).rev() {
                let pass = frame.fullscreen(format_args!("widen {}", level + 1), &self.upsample);
                let smallest = level + 2 == levels;
                let pass = pass.subresource(mip(level + 1)).sample(if smallest { &down } else { &up });
                let pass = pass.sampler(&self.linear).subresource(mip(level)).sample(&down);
                pass.subresource(mip(level)).draw(&mut up);
            }
            (spread, top) = (up, 0);
        }
        let pass = frame.fullscreen("mix", &self.mix).sample(light).subresource(mip(top)).sample(&spread);
        pass.sampler(&self.linear).uniform(bytes_of(&strength)).draw(target);
    }
}
