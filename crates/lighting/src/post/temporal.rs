//! Temporal anti-aliasing.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use bytemuck::{NoUninit, bytes_of};
use glam::{DMat4, Mat4, Vec2};
use shadowgraph_core::{Format, Frame, FullscreenShader, Resize, Texture};
use shadowgraph_scene::Camera;

use crate::error::Error;
use crate::shader::{fullscreen, linear_sampler};
use crate::uniforms::ViewBuffers;

/// Temporal anti-aliasing: sample positions are jittered in each frame ([`Jitter`](super::Jitter)), and the result is blended with the
/// reprojected history (Karis, "High Quality Temporal Supersampling", 2014), clipped to the neighbourhood of the pixel (Salvi,
/// "An Excursion in Temporal Supersampling", 2016). Reprojection follows the camera; moving objects rely on clipping alone.
pub struct Temporal {
    shader: FullscreenShader,
    linear: wgpu::Sampler,
    /// The unjittered `clip_from_world` of the previous frame of each view.
    previous: Mutex<BTreeMap<u32, DMat4>>,
}

/// `Settings` of `post/temporal.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct TemporalUniforms {
    previous_from_current: Mat4,
    jitter_px: Vec2,
    current_weight: f32,
    history_valid: f32,
}

impl Temporal {
    /// Composes the shader.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = fullscreen(device, "post/temporal.wgsl", "fs_temporal")?;
        Ok(Self { shader, linear: linear_sampler(device), previous: Mutex::default() })
    }

    /// Adds the pass, and returns the light of this frame blended with the history. `number` identifies the view among those of
    /// a frame; `view` has the jitter of this frame; `current_weight` is the weight of this frame, 0.01 to 1.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        [light, depth]: [&Texture; 2],
        (number, camera): (u32, &Camera),
        view: &ViewBuffers,
        current_weight: f32,
    ) -> Texture {
        let desc =
            frame.texture_desc(light).unwrap_or(shadowgraph_core::TextureDesc::d2(1, 1, Format::Rgba16Float));
        let aspect = f64::from(desc.size.width) / f64::from(desc.size.height.max(1));
        let current = camera.clip_from_view(aspect) * camera.view_from_world();
        let previous = {
            let mut by_view = self.previous.lock().unwrap_or_else(PoisonError::into_inner);
            by_view.insert(number, current)
        };
        let mut history = frame.history("mixed light", desc, Resize::Reset);
        let uniforms = TemporalUniforms {
            previous_from_current: (previous.unwrap_or(current) * current.inverse()).as_mat4(),
            jitter_px: view.jitter_px,
            current_weight: current_weight.clamp(0.01, 1.0),
            history_valid: f32::from(u8::from(history.valid && previous.is_some())),
        };
        let pass = frame.fullscreen("temporal", &self.shader).sample(light).sample(&history.previous);
        let pass = pass.sample(depth).sampler(&self.linear).uniform(bytes_of(&uniforms));
        pass.draw(&mut history.current);
        history.current
    }
}
