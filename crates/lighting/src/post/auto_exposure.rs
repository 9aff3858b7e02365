//! Automatic exposure.

use bytemuck::{NoUninit, bytes_of};
use shadowgraph_core::{
    ComputeShader, Contents, Format, Frame, FullscreenShader, Resize, Texture, TextureDesc,
};

use crate::error::Error;
use crate::shader::{fullscreen, module};

/// Exposure by the histogram of the image: it brings the median towards a key value, and keeps highlights below white (Reinhard et
/// al., "Photographic Tone Reproduction for Digital Images", 2002, for the key; Krawczyk et al., "Perceptual Effects in Real-time
/// Tone Mapping", 2005, for adaptation over frames).
pub struct AutoExposure {
    histogram: ComputeShader,
    exposure: FullscreenShader,
    /// The exposure, mixed with that of the previous frame.
    adapted: FullscreenShader,
}

/// Settings of automatic exposure. Brightness is that of the brightest channel, before tonemapping: 1 is white in full light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutoExposureSettings {
    /// The brightness to which the median of the pixels is brought, above 0.
    pub key: f32,
    /// How much of the way there, as a share of the logarithm, 0 to 1.
    pub strength: f32,
    /// The share of the pixels that may be brighter than `white`, 0 to 1.
    pub highlights: f32,
    /// The brightness that the other pixels stay below, above 0.
    pub white: f32,
    /// The range of the factor, in factors of two darker and brighter.
    pub range_stops: f32,
    /// The weight of a frame after others, above 0: how quickly the exposure adapts. With 1 each frame has the exposure of its image,
    /// whatever came before.
    pub adaptation: f32,
}

impl Default for AutoExposureSettings {
    fn default() -> Self {
        Self { key: 0.35, strength: 0.5, highlights: 0.01, white: 2.5, range_stops: 3.0, adaptation: 1.0 }
    }
}

/// `Settings` of `post/exposure.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct ExposureUniforms {
    key: f32,
    strength: f32,
    highlights: f32,
    white: f32,
    least: f32,
    largest: f32,
    weight: f32,
}

/// The shader of the histogram.
const HISTOGRAM: &str = "post/histogram.wgsl";
/// Number of bins of the histogram.
const BINS: usize = 128;
/// Pixels per workgroup, in x and y.
const GROUP_PX: [u32; 2] = [16, 32];

impl AutoExposure {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self {
            histogram: ComputeShader::module(HISTOGRAM, &module(device, HISTOGRAM, &[])?),
            exposure: fullscreen(device, "post/exposure.wgsl", "fs_exposure")?,
            adapted: fullscreen(device, "post/exposure.wgsl", "fs_exposure_adapted")?,
        })
    }

    /// Adds the passes, and returns one texel: the factor for the light of this frame. Pixels with alpha 0 do not count, nor black
    /// ones with alpha below 1, which are shadows on a transparent background. With [`adaptation`](AutoExposureSettings::adaptation)
    /// below 1, the exposure follows the image over frames.
    pub fn add_to(&self, frame: &mut Frame<'_>, light: &Texture, settings: &AutoExposureSettings) -> Texture {
        let size = frame.texture_desc(light).map(|desc| desc.size).unwrap_or_default();
        let mut bins = frame.upload_buffer("histogram", vec![0; 4 * BINS]);
        let groups = [size.width.div_ceil(GROUP_PX[0]), size.height.div_ceil(GROUP_PX[1]), 1];
        let pass = frame.compute("histogram", &self.histogram).sample(light);
        pass.storage_mut(&mut bins, Contents::Preserve).dispatch(groups);
        let AutoExposureSettings { key, strength, highlights, white, range_stops, adaptation } = *settings;
        let uniforms = ExposureUniforms {
            key,
            strength,
            highlights,
            white,
            least: (-range_stops).exp2(),
            largest: range_stops.exp2(),
            weight: 1.0,
        };
        let desc = TextureDesc::d2(1, 1, Format::R32Float);
        if adaptation >= 1.0 {
            let mut exposure = frame.create_texture("exposure", desc);
            let pass = frame.fullscreen("exposure", &self.exposure).storage(&bins);
            pass.uniform(bytes_of(&uniforms)).draw(&mut exposure);
            return exposure;
        }
        let mut history = frame.history("exposure", desc, Resize::Reset);
        let weight = if history.valid { adaptation.max(0.001) } else { 1.0 };
        let uniforms = ExposureUniforms { weight, ..uniforms };
        let pass = frame.fullscreen("exposure", &self.adapted).storage(&bins);
        pass.uniform(bytes_of(&uniforms)).sample(&history.previous).draw(&mut history.current);
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
        let module = compose("post/exposure.wgsl", &[]).unwrap();
        check_layout!(&module, "Settings", ExposureUniforms:
            key, strength, highlights, white, least, largest, weight,
        )
        .unwrap();
    }
}
