//! Screen-space ambient occlusion.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{Format, Frame, FullscreenShader, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::fullscreen;
use crate::uniforms::ViewBuffers;

/// Ambient occlusion from the horizons in screen-space depth (Jimenez et al., "Practical Real-Time Strategies for Accurate
/// Indirect Occlusion", 2016).
pub struct Occlusion {
    shader: FullscreenShader,
    blur: FullscreenShader,
}

/// Settings of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// Radius of occluders, metres, above 0.
    pub radius_m: f32,
    /// Exponent of the occlusion: 1 is physical, more is darker.
    pub power: f32,
    /// Number of directions in which horizons are searched, at least 1.
    pub slices: u32,
    /// Number of steps per direction, at least 1.
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
struct OcclusionUniforms {
    radius_m: f32,
    power: f32,
    slices: u32,
    steps: u32,
}

impl Occlusion {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            shader: fullscreen(device, "post/occlusion.wgsl", "fs_occlusion")?,
            blur: fullscreen(device, "post/occlusion_blur.wgsl", "fs_blur")?,
        })
    }

    /// Adds the passes, and returns the buffers with ambient occlusion, for lit passes to read. `depth` must have one sample
    /// per pixel.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        view: &ViewBuffers,
        depth: &Texture,
        settings: &OcclusionSettings,
    ) -> ViewBuffers {
        let size = frame.texture_desc(depth).map(|desc| desc.size).unwrap_or_default();
        let desc = TextureDesc::d2(size.width, size.height, Format::R8Unorm);
        let mut noisy = frame.create_texture("occlusion with grain", desc);
        let mut smooth = frame.create_texture("occlusion", desc);
        let &OcclusionSettings { radius_m, power, slices, steps } = settings;
        let uniforms = OcclusionUniforms { radius_m, power, slices: slices.max(1), steps: steps.max(1) };
        let horizons = frame.fullscreen("horizons", &self.shader).storage(&view.view).sample(depth);
        horizons.uniform(bytes_of(&uniforms)).draw(&mut noisy);
        frame
            .fullscreen("smooth", &self.blur)
            .storage(&view.view)
            .sample(depth)
            .sample(&noisy)
            .draw(&mut smooth);
        ViewBuffers { occlusion: Some(smooth), ..view.clone() }
    }
}
