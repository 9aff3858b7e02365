//! Screen-space ambient occlusion.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{Format, Frame, FullscreenShader, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::{fullscreen, fullscreen_with};
use crate::uniforms::ViewBuffers;

/// Ambient occlusion from the horizons in screen-space depth (Jimenez et al., "Practical Real-Time Strategies for Accurate
/// Indirect Occlusion", 2016).
pub struct Occlusion {
    /// The view depth of depth with one sample per pixel.
    view_depth: FullscreenShader,
    /// The view depth of the first sample of multisampled depth.
    view_depth_multisampled: FullscreenShader,
    horizons: FullscreenShader,
    blur: FullscreenShader,
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
        let view_depth = |kind| {
            fullscreen_with(device, "post/view_depth.wgsl", "fs_view_depth", ("texture_depth_2d", kind))
        };
        Ok(Self {
            view_depth: view_depth("texture_depth_2d")?,
            view_depth_multisampled: view_depth("texture_depth_multisampled_2d")?,
            horizons: fullscreen(device, "post/occlusion.wgsl", "fs_occlusion")?,
            blur: fullscreen(device, "post/occlusion_blur.wgsl", "fs_blur")?,
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
        let converter = if is_multisampled { &self.view_depth_multisampled } else { &self.view_depth };
        let texture = |format| TextureDesc::d2(size.width, size.height, format);
        let mut view_depth = frame.create_texture("view depth", texture(Format::R32Float));
        let mut noisy = frame.create_texture("occlusion with grain", texture(Format::R8Unorm));
        let mut smooth = frame.create_texture("occlusion", texture(Format::R8Unorm));
        let ground = GroundPlane {
            height: view.ground_height.unwrap_or_default(),
            exists: u32::from(view.ground_height.is_some()),
        };
        let &OcclusionSettings { radius_m, power, slices, steps } = settings;
        let uniforms = OcclusionUniforms { radius_m, power, slices: slices.max(1), steps: steps.max(1) };
        let convert = frame.fullscreen("view depth", converter).uniform_buffer(&view.view).sample(depth);
        convert.uniform(bytes_of(&ground)).draw(&mut view_depth);
        let horizons =
            frame.fullscreen("horizons", &self.horizons).uniform_buffer(&view.view).sample(&view_depth);
        horizons.uniform(bytes_of(&uniforms)).draw(&mut noisy);
        let blur = frame.fullscreen("smooth", &self.blur).uniform_buffer(&view.view);
        blur.sample(&view_depth).sample(&noisy).draw(&mut smooth);
        ViewBuffers { occlusion: Some(smooth), ..view.clone() }
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_shaders::{check_layout, compose};

    use super::*;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_structs() {
        let module = compose("post/occlusion.wgsl", &[]).unwrap();
        check_layout!(&module, "Settings", OcclusionUniforms: radius_m, power, slices, steps).unwrap();
        let module = compose("post/view_depth.wgsl", &[]).unwrap();
        check_layout!(&module, "GroundPlane", GroundPlane: height, exists).unwrap();
    }
}
