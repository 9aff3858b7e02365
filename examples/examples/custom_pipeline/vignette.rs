//! A custom node, for files and for scripts.

use shadowgraph::core::{Format, Frame, FullscreenShader, Texture};
use shadowgraph::nodes::{Node, Port, Ports, Setting, SettingType, Settings};
use shadowgraph::{BuildContext, Error, RenderView};

/// Darkens the corners of the image.
pub(crate) struct Vignette {
    shader: FullscreenShader,
    strength: f32,
}

impl Node for Vignette {
    const NAME: &'static str = "vignette";
    const ABOUT: &'static str = "darkens the corners of the image";
    const INPUTS: &'static [Port] = &[Port::texture("light", "the lit scene")];
    const OUTPUTS: &'static [Port] = &[Port::texture("light", "the same, darker in the corners")];
    const SETTINGS: &'static [Setting] =
        &[Setting::new("strength", SettingType::Number(0.5, 0.0, 1.0), "how dark the corners are")];

    fn new(_context: &BuildContext<'_>, settings: &Settings) -> Result<Self, Error> {
        Ok(Self::with_strength(settings.number("strength")?))
    }

    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        ports: &mut Ports<'_, 'f>,
    ) -> Result<(), Error> {
        let mut darker = ports.create("light", frame, view.texture_desc(Format::Rgba16Float));
        self.draw(frame, &ports.texture("light")?, &mut darker);
        ports.set("light", darker);
        Ok(())
    }
}

impl Vignette {
    pub(crate) fn with_strength(strength: f32) -> Self {
        Self { shader: FullscreenShader::wgsl("vignette", include_str!("vignette.wgsl")), strength }
    }

    pub(crate) fn draw(&self, frame: &mut Frame<'_>, light: &Texture, darker: &mut Texture) {
        let pass = frame.fullscreen("vignette", &self.shader).sample(light);
        pass.uniform(&self.strength.to_le_bytes()).draw(darker);
    }
}
