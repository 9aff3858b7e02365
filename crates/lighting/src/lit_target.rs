//! What lit passes write, and into what.

use shadowgraph_core::Format;
use shadowgraph_shadows::ShadowOutputs;

/// The output of a lit pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LitOutput {
    /// Light, scene-linear, exposure applied.
    #[default]
    Light,
    /// The visibility of this light as grey, with alpha 0 where nothing is drawn or the surface faces away. Blended
    /// geometry is not drawn, here and in the outputs below.
    Visibility(u32),
    /// The technique's debug colours for [`ShadowOutputs::debug_light`].
    Debug,
    /// The shading normal, each axis mapped from -1..1 to 0..1.
    Normal,
    /// Positions relative to the frame's origin, metres, and in `w` the geometric normal in octahedral encoding:
    /// 1 + 4096 x + y, each axis 0 to 4095. 0 where nothing is drawn. Requires `Rgba32Float`.
    Surface,
}

/// The target of a lit pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LitTarget {
    /// The format of the texture.
    pub format: Format,
    /// The output that is written.
    pub output: LitOutput,
    /// Samples per pixel while drawing, 1 or 4; they are resolved to one. Shadows are evaluated once per pixel and surface,
    /// and a screen mask has one value for all surfaces of a pixel.
    pub samples: u32,
}

impl LitTarget {
    /// Returns the variant of the technique that a pass needs, and the light whose debug colours it shows. Only variant 0
    /// has debug colours.
    pub(crate) fn variant(&self, shadows: &ShadowOutputs<'_>) -> (u32, u32) {
        match self.output {
            LitOutput::Debug => (0, shadows.debug_light),
            _ => (shadows.variant, 0),
        }
    }

    /// Returns the values of `AOV` and `AOV_LIGHT` in the shaders.
    pub(crate) fn constants(&self, debug_light: u32) -> [(&'static str, f64); 2] {
        let (aov, light) = match self.output {
            LitOutput::Light => (0, 0),
            LitOutput::Visibility(light) => (1, light),
            LitOutput::Debug => (2, debug_light),
            LitOutput::Normal => (3, 0),
            LitOutput::Surface => (4, 0),
        };
        [("AOV", f64::from(aov)), ("AOV_LIGHT", f64::from(light))]
    }
}
