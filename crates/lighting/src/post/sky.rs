//! A simple sky.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::error::Error;
use crate::shader::fullscreen;
use crate::uniforms::ViewBuffers;

/// The sky behind the scene: the ambient light, brighter towards the horizon, and the discs of directional lights.
pub struct Sky {
    shader: FullscreenShader,
}

/// Settings of the sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkySettings {
    /// Angular radius of the discs, radians; the sun's is 0.00465.
    pub disc_rad: f32,
    /// The additional brightness of the horizon relative to the zenith, 0 or more.
    pub haze: f32,
}

impl Default for SkySettings {
    fn default() -> Self {
        Self { disc_rad: 0.012, haze: 0.8 }
    }
}

/// `Settings` of `post/sky.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct SkyUniforms {
    disc_rad: f32,
    haze: f32,
    padding: [u32; 2],
}

impl Sky {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { shader: fullscreen(device, "post/sky.wgsl", "fs_sky")? })
    }

    /// Adds the pass that draws the sky into `light` where `depth` is at the far plane. Both must have the same number of
    /// samples.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        view: &ViewBuffers,
        depth: &Texture,
        light: &mut Texture,
        settings: &SkySettings,
    ) {
        let uniforms = SkyUniforms { disc_rad: settings.disc_rad, haze: settings.haze, padding: [0; 2] };
        let pass = frame.fullscreen("sky", &self.shader).storage(&view.view).storage(&view.lights);
        let pass = pass.uniform(bytes_of(&uniforms)).depth_test(depth, wgpu::CompareFunction::Equal);
        pass.draw_over(light, None);
    }
}
