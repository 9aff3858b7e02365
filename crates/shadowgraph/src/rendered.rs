//! Images on the CPU.

use std::sync::Arc;

use shadowgraph_core::{PassTime, Plan, ValueReport};
use shadowgraph_scene::{linear_from_srgb, srgb_from_linear};
use shadowgraph_shadows::Unshadowed;

/// An image: 8 bit red, green, blue and alpha, rows from the top without padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RenderedImage {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Four bytes per pixel.
    pub rgba8: Vec<u8>,
}

impl RenderedImage {
    /// Returns the pixel at `x` from the left and `y` from the top; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        let [width, height] = self.size_px;
        let start = (x < width && y < height).then(|| (y as usize * width as usize + x as usize) * 4)?;
        self.rgba8.get(start..start + 4)?.try_into().ok()
    }

    /// Returns the pixels of an image whose colours are multiplied by alpha in linear light, with straight alpha, as PNG files have
    /// them.
    pub fn straight_alpha(&self) -> Vec<u8> {
        let divided = |channel: u8, alpha: u8| match alpha {
            0 => 0,
            u8::MAX => channel,
            _ => srgb_from_linear(linear_from_srgb(channel) * 255.0 / f64::from(alpha)),
        };
        let pixels = self.rgba8.as_chunks::<4>().0.iter();
        pixels.flat_map(|&[r, g, b, a]| [divided(r, a), divided(g, a), divided(b, a), a]).collect()
    }
}

/// A view that was drawn and read back.
#[derive(Debug)]
pub struct RenderedFrame {
    /// The image.
    pub image: RenderedImage,
    /// The plan; equal frames share it.
    pub plan: Arc<Plan>,
    /// The time of each pass, if it was measured.
    pub times: Vec<PassTime>,
    /// The lights that should cast shadows and do not, with the reason.
    pub unshadowed: Vec<Unshadowed>,
    /// What the GPU has counted.
    pub counts: FrameCounts,
    /// Values that textures should not have, if [the graph checks them](shadowgraph_core::Graph::check_values).
    pub values: Option<ValueReport>,
}

/// What the GPU counts in a frame.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FrameCounts {
    /// How many instances the passes draw that the GPU has culled; empty if the CPU culls.
    pub culled: Vec<CulledView>,
    /// What the shadow technique counts, such as pages; empty for most.
    pub shadows: Vec<(&'static str, u32)>,
    /// What users should know about these numbers.
    pub shadow_warning: Option<String>,
}

/// How many instances a view draws that the GPU has culled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CulledView {
    /// The name of the view: `camera`, what of it was seen before or is new, or a tile.
    pub view: String,
    /// The number of instances.
    pub instances: u32,
}

impl RenderedFrame {
    /// Returns the GPU time of the shadow passes, milliseconds: 0 without any. `None` if times were not measured, or the device
    /// does not support it. Shadow lookups are part of the lighting, unless they are computed in a screen-space mask.
    pub fn shadow_ms(&self) -> Option<f64> {
        shadow_ms(&self.times)
    }
}

/// Returns the GPU time of the shadow passes among the passes of a frame, as [`RenderedFrame::shadow_ms`] does.
pub fn shadow_ms(times: &[PassTime]) -> Option<f64> {
    let is_shadow = |time: &&PassTime| time.pass.split('/').any(|part| part.ends_with("shadows"));
    if times.is_empty() {
        return None;
    }
    times.iter().filter(is_shadow).map(PassTime::gpu_share_ms).sum()
}
