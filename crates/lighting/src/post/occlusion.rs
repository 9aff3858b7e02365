//! Ambient occlusion of the screen.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{Format, Frame, FullscreenShader, Texture, TextureDesc};

use crate::shader::fullscreen;
use crate::{Error, ViewBuffers};

/// How much of the light from all around reaches what is seen, by the horizons in the depth of the picture (Jimenez et al.,
/// "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016).
pub struct Occlusion {
    shader: FullscreenShader,
    blur: FullscreenShader,
}

/// How ambient occlusion is found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// How far surroundings matter, metres: over 0.
    pub radius_m: f32,
    /// 1 as it is, more for darker corners.
    pub power: f32,
    /// In how many directions horizons are looked for, at least 1.
    pub slices: u32,
    /// In how many steps each way, at least 1.
    pub steps: u32,
}

impl Default for OcclusionSettings {
    fn default() -> Self {
        Self { radius_m: 0.8, power: 1.0, slices: 3, steps: 4 }
    }
}

/// `Settings` of `post/occlusion.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Block {
    radius_m: f32,
    power: f32,
    slices: u32,
    steps: u32,
}

impl Occlusion {
    /// Composes the shaders.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            shader: fullscreen(device, "post/occlusion.wgsl", "fs_occlusion")?,
            blur: fullscreen(device, "post/occlusion_blur.wgsl", "fs_blur")?,
        })
    }

    /// Adds the passes, and returns what passes that light bind so that they occlude the light from all around. `depth` has one
    /// sample a pixel.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        view: &ViewBuffers,
        depth: &Texture,
        settings: &OcclusionSettings,
    ) -> ViewBuffers {
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let desc = TextureDesc::d2(size.width, size.height, Format::R8Unorm);
        let mut grainy = frame.create_texture("occlusion with grain", desc);
        let mut smooth = frame.create_texture("occlusion", desc);
        let &OcclusionSettings { radius_m, power, slices, steps } = settings;
        let block = Block { radius_m, power, slices: slices.max(1), steps: steps.max(1) };
        let horizons = frame.fullscreen("horizons", &self.shader).storage(&view.view).sample(depth);
        horizons.uniform(bytes_of(&block)).draw(&mut grainy);
        frame
            .fullscreen("smooth", &self.blur)
            .storage(&view.view)
            .sample(depth)
            .sample(&grainy)
            .draw(&mut smooth);
        ViewBuffers { occlusion: Some(smooth), ..view.clone() }
    }
}
