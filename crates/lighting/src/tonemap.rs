//! Tonemapping of scene-linear light.

use bytemuck::{NoUninit, bytes_of};
use glam::Vec4;
use shadowgraph_core::{Frame, FullscreenShader, Texture};

use crate::error::Error;
use crate::shader::fullscreen;

/// The filmic tonemap: one fullscreen pass into an sRGB target.
pub struct Tonemap {
    opaque: FullscreenShader,
    over_background: FullscreenShader,
    exposed: FullscreenShader,
}

/// Settings of the tonemap of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TonemapSettings {
    /// One texel whose red channel multiplies all light ([`AutoExposure`](crate::post::AutoExposure)).
    pub exposure: Option<Texture>,
    /// Shown where the light's alpha is below 1, as it is: linear RGB multiplied by alpha, and alpha. With `None` the image is
    /// opaque.
    pub background: Option<Vec4>,
}

/// `Settings` of `tonemap.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, NoUninit)]
struct TonemapUniforms {
    background: Vec4,
    has_background: u32,
    padding: [u32; 3],
}

impl Tonemap {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        let shader = |entry| fullscreen(device, "tonemap.wgsl", entry);
        Ok(Self {
            opaque: shader("fs_tonemap")?,
            over_background: shader("fs_tonemap_background")?,
            exposed: shader("fs_tonemap_exposed")?,
        })
    }

    /// Adds the pass that overwrites `target`, which must have an sRGB format, with the tonemapped `light`. Both must have
    /// the same size.
    pub fn add_to(
        &self,
        frame: &mut Frame<'_>,
        light: &Texture,
        target: &mut Texture,
        settings: &TonemapSettings,
    ) {
        let uniforms = TonemapUniforms {
            background: settings.background.unwrap_or_default(),
            has_background: u32::from(settings.background.is_some()),
            padding: [0; 3],
        };
        let shader = match settings {
            TonemapSettings { exposure: Some(_), .. } => &self.exposed,
            TonemapSettings { background: Some(_), .. } => &self.over_background,
            _ => &self.opaque,
        };
        let mut pass = frame.fullscreen("tonemap", shader).sample(light);
        if *settings != TonemapSettings::default() {
            pass = pass.uniform(bytes_of(&uniforms));
        }
        if let Some(exposure) = &settings.exposure {
            pass = pass.sample(exposure);
        }
        pass.draw(target);
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_shaders::{check_layout, compose};

    use super::*;

    #[test]
    fn uniforms_have_the_layout_of_the_wgsl_struct() {
        let module = compose("tonemap.wgsl", &[]).unwrap();
        check_layout!(&module, "Settings", TonemapUniforms: background, has_background).unwrap();
    }
}
