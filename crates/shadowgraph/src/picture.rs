//! Pictures on the CPU.

use std::sync::Arc;

use shadowgraph_core::{PassTime, Plan};
use shadowgraph_shadows::Unshadowed;

/// A picture: 8 bit red, green, blue and alpha, rows from the top without padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Four bytes a pixel.
    pub rgba8: Vec<u8>,
}

impl Picture {
    /// Returns the pixel at `x` from the left and `y` from the top; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        let [width, height] = self.size_px;
        let at = (x < width && y < height).then(|| (y as usize * width as usize + x as usize) * 4)?;
        self.rgba8.get(at..at + 4)?.try_into().ok()
    }
}

/// A drawn view.
#[derive(Debug)]
pub struct Drawn {
    /// What was drawn.
    pub picture: Picture,
    /// How; equal frames share it.
    pub plan: Arc<Plan>,
    /// How long each pass took, if it was measured.
    pub times: Vec<PassTime>,
    /// The lights that are to cast shadows but have none, and why.
    pub unshadowed: Vec<Unshadowed>,
}

impl Drawn {
    /// Returns how long the GPU took for the shadow passes, milliseconds: 0 without any. `None` if times were not measured, or
    /// the device cannot tell them. Looking shadows up is part of lighting, and not counted but with a screen mask.
    pub fn shadow_ms(&self) -> Option<f64> {
        let is_shadow = |time: &&PassTime| time.pass.split('/').any(|part| part.ends_with("shadows"));
        if self.times.is_empty() {
            return None;
        }
        self.times.iter().filter(is_shadow).map(PassTime::gpu_share_ms).sum()
    }
}
