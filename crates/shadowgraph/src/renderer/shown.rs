//! What of a frame is shown.

use shadowgraph_core::{Buffer, Format, Frame, Texture};
use shadowgraph_lighting::LitOutput;
use shadowgraph_scene::Light;
use shadowgraph_shadows::{ShadowOutputs, Unshadowed};

use super::Renderer;
use crate::Error;
use crate::nodes::near_words;
use crate::options::Aov;
use crate::pipelines::{Output, View};

impl Renderer {
    /// Adds the passes of a view, and those that show what is asked for.
    pub(crate) fn add<'f>(&'f self, frame: &mut Frame<'f>, view: &'f View<'f>) -> Result<Shown, Error> {
        let output = self.wiring.add(frame, view)?;
        let picture = self.shown(frame, view, &output)?;
        let ShadowOutputs { debug_buffers: records, unshadowed, .. } = output.shadows;
        Ok(Shown { picture, records, unshadowed })
    }

    /// What is asked for; passes that it does not need are culled.
    fn shown<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f View<'f>,
        output: &Output<'f>,
    ) -> Result<Texture, Error> {
        let none = |output| Error::NoOutput {
            aov: self.aov.to_string(),
            pipeline: self.method.pipeline.name().into(),
            output,
        };
        let size_px = view.options.size_px;
        let buffers = || output.view.as_ref().ok_or_else(|| none("view"));
        match &self.aov {
            Aov::Color => Ok(output.picture.clone()),
            Aov::Visibility(_) | Aov::Cascade | Aov::Normal => {
                output.light.clone().ok_or_else(|| none("light"))
            }
            Aov::Depth => {
                let depth = output.depth.as_ref().ok_or_else(|| none("depth"))?;
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.depth(frame, buffers, depth, size_px)))
            }
            Aov::Atlas => {
                let maps: Vec<&Texture> = output.shadows.debug.iter().map(|(_, texture)| texture).collect();
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.textures(frame, buffers, &maps, size_px)))
            }
            Aov::Texture(name) => {
                let texture = frame.find_texture(name).ok_or_else(|| no_texture(frame, name))?;
                has_picture(frame, &texture, name)?;
                let buffers = buffers()?;
                Ok(frame.node("picture", |frame| self.show.textures(frame, buffers, &[&texture], size_px)))
            }
        }
    }
}

/// What a view gives.
pub(crate) struct Shown {
    /// Four bytes a pixel, as large as the view.
    pub(crate) picture: Texture,
    /// The records of shadow maps, where there are any.
    pub(crate) records: Option<[Buffer; 2]>,
    /// The lights that are to cast shadows but have none, and why.
    pub(crate) unshadowed: Vec<Unshadowed>,
}

/// An error for textures of whole numbers.
fn has_picture(frame: &Frame<'_>, texture: &Texture, name: &str) -> Result<(), Error> {
    let desc = frame.texture_desc(texture);
    let Some(format) = desc.map(|desc| desc.format).filter(|format| !format.is_depth_stencil_format()) else {
        return Ok(());
    };
    match format.sample_type(None, None) {
        Some(wgpu::TextureSampleType::Float { .. }) => Ok(()),
        _ => Err(Error::NoPicture { name: name.into(), format }),
    }
}

fn no_texture(frame: &Frame<'_>, name: &str) -> Error {
    let textures = frame.texture_names().filter(|name| !Aov::NAMES.contains(name));
    Error::NoTexture { name: name.into(), hint: near_words(name, Aov::NAMES.into_iter().chain(textures)) }
}

/// What the lit pass writes for an output, and in which format.
pub(super) fn lit_output(aov: &Aov, lights: &[Light]) -> Result<(LitOutput, Format), Error> {
    Ok(match aov {
        Aov::Visibility(light) if *light as usize >= lights.len() => {
            let there_are = match lights.len() {
                0 => "the scene has no light".into(),
                1 => "the scene has one light, 0".into(),
                count => format!("the scene has lights 0 to {}", count - 1),
            };
            return Err(Error::NoLight { light: *light, there_are });
        }
        Aov::Visibility(light) => (LitOutput::Visibility(*light), Format::Rgba8Unorm),
        Aov::Cascade => (LitOutput::Debug, Format::Rgba8Unorm),
        Aov::Normal => (LitOutput::Normal, Format::Rgba8Unorm),
        Aov::Color | Aov::Depth | Aov::Atlas | Aov::Texture(_) => (LitOutput::Light, Format::Rgba16Float),
    })
}
