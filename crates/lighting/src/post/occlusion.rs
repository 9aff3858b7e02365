//! Screen-space ambient occlusion.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{Format, Frame, FullscreenShader, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::fullscreen_with;
use crate::uniforms::ViewBuffers;

/// Ambient occlusion from the horizons in screen-space depth (Jimenez et al., "Practical Real-Time Strategies for Accurate
/// Indirect Occlusion", 2016).
pub struct Occlusion {
    /// Of depth with one sample per pixel.
    single: Shaders,
    /// Of the first sample of multisampled depth.
    multisampled: Shaders,
}

struct Shaders {
    horizons: FullscreenShader,
    blur: FullscreenShader,
}

impl Shaders {
    fn new(device: &wgpu::Device, depth_type: &str) -> Result<Self, Error> {
        let shader = |file, entry| fullscreen_with(device, file, entry, ("texture_depth_2d", depth_type));
        Ok(Self {
            horizons: shader("post/occlusion.wgsl", "fs_occlusion")?,
            blur: shader("post/occlusion_blur.wgsl", "fs_blur")?,
        })
    }
}

/// Settings of ambient occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OcclusionSettings {
    /// Radius of occluders, metres; 0: a tenth of what the image's height spans at the depth of each pixel, for scenes of any scale.
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
    ground: GroundPlane,
}

/// `GroundPlane` of `ground_depth.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct GroundPlane {
    height: f32,
    exists: u32,
}

impl Occlusion {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            single: Shaders::new(device, "texture_depth_2d")?,
            multisampled: Shaders::new(device, "texture_depth_multisampled_2d")?,
        })
    }

    /// Adds the passes, and returns the buffers with ambient occlusion, for lit passes to read. The first sample
    /// of each pixel of `depth` counts. The plane of the view that receives shadows is occluded too.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        view: &ViewBuffers,
        depth: &Texture,
        settings: &OcclusionSettings,
    ) -> ViewBuffers {
        let depth_desc = frame.texture_desc(depth);
        let size = depth_desc.map(|desc| desc.size).unwrap_or_default();
        let is_multisampled = depth_desc.is_some_and(|desc| desc.samples > 1);
        let shaders = if is_multisampled { &self.multisampled } else { &self.single };
        let desc = TextureDesc::d2(size.width, size.height, Format::R8Unorm);
        let mut noisy = frame.create_texture("occlusion with grain", desc);
        let mut smooth = frame.create_texture("occlusion", desc);
        let &OcclusionSettings { radius_m, power, slices, steps } = settings;
        let ground = GroundPlane {
            height: view.ground_height.unwrap_or_default(),
            exists: u32::from(view.ground_height.is_some()),
        };
        let (slices, steps) = (slices.max(1), steps.max(1));
        let uniforms = OcclusionUniforms { radius_m, power, slices, steps, ground };
        let horizons = frame.fullscreen("horizons", &shaders.horizons).storage(&view.view).sample(depth);
        horizons.uniform(bytes_of(&uniforms)).draw(&mut noisy);
        frame
            .fullscreen("smooth", &shaders.blur)
            .storage(&view.view)
            .sample(depth)
            .sample(&noisy)
            .uniform(bytes_of(&ground))
            .draw(&mut smooth);
        ViewBuffers { occlusion: Some(smooth), ..view.clone() }
    }
}
