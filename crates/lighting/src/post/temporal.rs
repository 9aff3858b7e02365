//! Temporal anti-aliasing.

use bytemuck::{NoUninit, bytes_of};
use glam::{Mat4, Vec2};
use shadowgraph_core::{Format, Frame, FullscreenShader, Resize, Texture, TextureDesc};

use crate::error::Error;
use crate::shader::{fullscreen, linear_sampler};
use crate::uniforms::ViewBuffers;

/// Temporal anti-aliasing: sample positions are jittered in each frame ([`Jitter`](super::Jitter)), and the result is blended with the
/// reprojected history (Karis, "High Quality Temporal Supersampling", 2014), clipped to the neighbourhood of the pixel (Salvi,
/// "An Excursion in Temporal Supersampling", 2016).
///
/// With motion vectors ([`Velocity`](crate::Velocity)) the history follows cameras and objects, and surfaces that were hidden in the
/// previous frame, by its depth, start again. Without them it follows the camera alone, and moving objects rely on clipping.
pub struct Temporal {
    by_camera: FullscreenShader,
    by_velocity: FullscreenShader,
    linear: wgpu::Sampler,
}

/// `Settings` of `post/temporal.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct TemporalUniforms {
    previous_from_current: Mat4,
    jitter_px: Vec2,
    current_weight: f32,
    history_valid: f32,
    depth_offset: f32,
    padding: [f32; 3],
}

impl Temporal {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = |entry| fullscreen(device, "post/temporal.wgsl", entry);
        Ok(Self {
            by_camera: shader("fs_temporal")?,
            by_velocity: shader("fs_temporal_velocity")?,
            linear: linear_sampler(device),
        })
    }

    /// Adds the pass, and returns the light of this frame blended with the history. `view` has the jitter and the camera's motion of
    /// this frame, `velocity` the motion vectors if there are any; `current_weight` is the weight of this frame, 0.01 to 1. With
    /// motion vectors the first frames of a surface weigh more: the light is their mean until that weight is reached.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        [light, depth]: [&Texture; 2],
        velocity: Option<&Texture>,
        view: &ViewBuffers,
        current_weight: f32,
    ) -> Texture {
        let desc = frame.texture_desc(light).unwrap_or(TextureDesc::d2(1, 1, Format::Rgba16Float));
        let mut history = frame.history("mixed light", desc, Resize::Reset);
        let mut uniforms = TemporalUniforms {
            previous_from_current: view.motion.previous_from_current().as_mat4(),
            jitter_px: view.jitter_px,
            current_weight: current_weight.clamp(0.01, 1.0),
            history_valid: f32::from(u8::from(history.valid)),
            depth_offset: view.motion.depth_offset() as f32,
            padding: [0.0; 3],
        };
        let Some(velocity) = velocity else {
            let pass = frame.fullscreen("temporal", &self.by_camera).sample(light).sample(&history.previous);
            let pass = pass.sample(depth).sampler(&self.linear).uniform(bytes_of(&uniforms));
            pass.draw(&mut history.current);
            return history.current;
        };
        let desc = TextureDesc { format: Format::Rg16Float, ..desc };
        let mut surface = frame.history("mixed surface", desc, Resize::Reset);
        uniforms.history_valid *= f32::from(u8::from(surface.valid));
        let pass = frame.fullscreen("temporal", &self.by_velocity).sample(light).sample(&history.previous);
        let pass = pass.sample(depth).sampler(&self.linear).uniform(bytes_of(&uniforms));
        let pass = pass.sample(velocity).sample(&surface.previous);
        pass.target(&mut history.current).draw(&mut surface.current);
        history.current
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_shaders::{check_layout, compose};

    use super::*;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_struct() {
        let module = compose("post/temporal.wgsl", &[]).unwrap();
        check_layout!(&module, "Settings", TemporalUniforms:
            previous_from_current, jitter_px, current_weight, history_valid, depth_offset,
        )
        .unwrap();
    }
}
