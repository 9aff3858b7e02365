//! Jitter of sample positions for temporal anti-aliasing.

use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

use glam::{Mat4, Vec2, Vec3};

/// The sample position of a frame within its pixels: one of sixteen positions in turn (Halton sequence of the bases 2 and 3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Jitter {
    frame: u32,
}

impl Jitter {
    /// The number of frames after which positions repeat.
    pub const FRAMES: u32 = 16;

    /// Returns the jitter of a frame.
    pub fn for_frame(frame: u32) -> Self {
        Self { frame: frame % Self::FRAMES }
    }

    /// Returns the offset from the centre of a pixel, at most half a pixel in each direction.
    ///
    /// ```
    /// use shadowgraph_lighting::post::Jitter;
    /// let offsets: Vec<_> = (0..Jitter::FRAMES).map(|frame| Jitter::for_frame(frame).offset_px()).collect();
    /// let mean = offsets.iter().copied().sum::<glam::Vec2>() / 16.0;
    /// assert!(mean.length() < 0.05 && offsets.iter().all(|offset| offset.abs().max_element() <= 0.5));
    /// ```
    pub fn offset_px(self) -> Vec2 {
        Vec2::new(halton(self.frame + 1, 2) - 0.5, halton(self.frame + 1, 3) - 0.5)
    }

    /// Returns the matrix that offsets clip space by the jitter, for an image of this size.
    pub fn clip_translation(self, size_px: [u32; 2]) -> Mat4 {
        let [width, height] = size_px.map(|px| px.max(1) as f32);
        let offset = self.offset_px();
        // Pixel y points down, clip space y up.
        Mat4::from_translation(Vec3::new(2.0 * offset.x / width, -2.0 * offset.y / height, 0.0))
    }
}

/// The jitter sequences of several views.
#[derive(Debug, Default)]
pub struct Jitters(Mutex<BTreeMap<u32, u32>>);

impl Jitters {
    /// Returns the jitter of a view's next frame.
    pub fn next(&self, view: u32) -> Jitter {
        let mut frames = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let frame = frames.entry(view).or_default();
        let jitter = Jitter::for_frame(*frame);
        *frame = (*frame + 1) % Jitter::FRAMES;
        jitter
    }
}

/// Returns the radical inverse of `index` in a base: its digits mirrored at the radix point.
fn halton(mut index: u32, base: u32) -> f32 {
    let (mut value, mut weight) = (0.0, 1.0);
    while index > 0 {
        weight /= base as f32;
        value += weight * (index % base) as f32;
        index /= base;
    }
    value
}
