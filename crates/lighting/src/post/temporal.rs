//! Light of several frames together.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use bytemuck::{NoUninit, bytes_of};
use glam::{DMat4, Mat4, Vec2, Vec3};
use shadowgraph_core::{Format, Frame, FullscreenShader, Resize, Texture};
use shadowgraph_scene::Camera;

use crate::shader::{fullscreen, linear};
use crate::{Error, ViewBuffers};

/// Temporal anti-aliasing: pixels look at another place in each frame ([`Jitter`]), and what they see is mixed with the frames
/// before, followed to where it was (Karis, "High Quality Temporal Supersampling", 2014), as far as its neighbours allow (Salvi, "An
/// Excursion in Temporal Supersampling", 2016). It follows the camera; what moves by itself is told by its neighbours alone.
pub struct Temporal {
    shader: FullscreenShader,
    linear: wgpu::Sampler,
    /// Of each view's frame before: clip space from the world, without its shift.
    before: Mutex<BTreeMap<u32, DMat4>>,
}

/// `Settings` of `post/temporal.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct Block {
    before_from_now: Mat4,
    shift_px: Vec2,
    fresh: f32,
    valid: f32,
}

impl Temporal {
    /// Composes the shader.
    ///
    /// # Errors
    /// None with the WGSL that Shadowgraph comes with.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = fullscreen(device, "post/temporal.wgsl", "fs_temporal")?;
        Ok(Self { shader, linear: linear(device), before: Mutex::default() })
    }

    /// Adds the pass, and returns the light of this frame with those before. `number` tells views of a frame apart; `view` is what
    /// was drawn by, with this frame's shift; `fresh` is the part of this frame, 0.01 to 1.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        [light, depth]: [&Texture; 2],
        (number, camera): (u32, &Camera),
        view: &ViewBuffers,
        fresh: f32,
    ) -> Texture {
        let desc =
            frame.texture_desc(light).unwrap_or(shadowgraph_core::TextureDesc::d2(1, 1, Format::Rgba16Float));
        let aspect = f64::from(desc.size.width) / f64::from(desc.size.height.max(1));
        let now = camera.clip_from_view(aspect) * camera.view_from_world();
        let before = {
            let mut known = self.before.lock().unwrap_or_else(PoisonError::into_inner);
            known.insert(number, now)
        };
        let mut history = frame.history("mixed light", desc, Resize::Reset);
        let block = Block {
            before_from_now: (before.unwrap_or(now) * now.inverse()).as_mat4(),
            shift_px: view.jitter_px,
            fresh: fresh.clamp(0.01, 1.0),
            valid: f32::from(u8::from(history.valid && before.is_some())),
        };
        let pass = frame.fullscreen("temporal", &self.shader).sample(light).sample(&history.previous);
        let pass = pass.sample(depth).sampler(&self.linear).uniform(bytes_of(&block));
        pass.draw(&mut history.current);
        history.current
    }
}

/// Where in a pixel frames look: sixteen places in turn (Halton's sequence of the bases 2 and 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Jitter {
    frame: u32,
}

impl Jitter {
    /// How many frames it takes until places come again.
    pub const FRAMES: u32 = 16;

    /// Returns the place of a frame.
    pub fn for_frame(frame: u32) -> Self {
        Self { frame: frame % Self::FRAMES }
    }

    /// Returns what pixels are shifted by, each way at most half a pixel.
    ///
    /// ```
    /// use shadowgraph_lighting::post::Jitter;
    /// let places: Vec<_> = (0..Jitter::FRAMES).map(|frame| Jitter::for_frame(frame).offset_px()).collect();
    /// let mean = places.iter().copied().sum::<glam::Vec2>() / 16.0;
    /// assert!(mean.length() < 0.05 && places.iter().all(|place| place.abs().max_element() <= 0.5));
    /// ```
    pub fn offset_px(self) -> Vec2 {
        Vec2::new(halton(self.frame + 1, 2) - 0.5, halton(self.frame + 1, 3) - 0.5)
    }

    /// Returns what shifts clip space so, in a picture of this size.
    pub fn clip_translation(self, size_px: [u32; 2]) -> Mat4 {
        let [width, height] = size_px.map(|px| px.max(1) as f32);
        let shift = self.offset_px();
        // Pixels go down, clip space up.
        Mat4::from_translation(Vec3::new(2.0 * shift.x / width, -2.0 * shift.y / height, 0.0))
    }
}

/// The places of the frames of each view, one after the other.
#[derive(Debug, Default)]
pub struct Jitters(Mutex<BTreeMap<u32, u32>>);

impl Jitters {
    /// Returns the place of a view's next frame.
    pub fn next(&self, view: u32) -> Jitter {
        let mut frames = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let frame = frames.entry(view).or_default();
        let jitter = Jitter::for_frame(*frame);
        *frame = (*frame + 1) % Jitter::FRAMES;
        jitter
    }
}

/// The digits of a number in a base, mirrored behind the point.
fn halton(mut index: u32, base: u32) -> f32 {
    let (mut value, mut part) = (0.0, 1.0);
    while index > 0 {
        part /= base as f32;
        value += part * (index % base) as f32;
        index /= base;
    }
    value
}
