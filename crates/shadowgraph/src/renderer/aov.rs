//! The image of a view, by AOV.

use shadowgraph_core::{Contents, Format, Frame, Texture, did_you_mean};
use shadowgraph_lighting::{LitOutput, ViewBuffers};
use shadowgraph_scene::Light;
use shadowgraph_shadows::ShadowOutputs;

use super::Renderer;
use crate::error::Error;
use crate::options::aov::Aov;
use crate::pipelines::instance::PipelineOutput;
use crate::render_view::RenderView;

impl Renderer {
    /// Adds the passes of a view, and those that display the AOV.
    ///
    /// # Errors
    /// For settings out of range, and for an output that the pipeline does not have.
    pub fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
    ) -> Result<ViewOutput<'f>, Error> {
        view.add_pose(frame);
        let output = self.instance.add(frame, view)?;
        self.previous_cameras.set(view.index, &view.options.camera, view.options.aspect());
        let mut image = self.aov_image(frame, view, &output)?;
        self.add_overlay(frame, view, &output, &mut image);
        let PipelineOutput { view, shadows, .. } = output;
        Ok(ViewOutput { image, view, shadows })
    }

    /// Draws the overlay over an image, if there is one.
    fn add_overlay<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &RenderView<'f>,
        output: &PipelineOutput<'f>,
        image: &mut Texture,
    ) {
        let Some(overlay) = &self.overlay else { return };
        let (Some(buffers), Some([views, _])) = (&output.view, &output.shadows.map_buffers) else { return };
        let origin_world = view.casters.scene.origin_world();
        let camera = (view.shadow_camera, view.options.aspect(), origin_world);
        frame.node("overlay", |frame| {
            overlay.add_to(frame, (buffers, views), camera, (image, Contents::Preserve));
        });
    }

    /// Returns the image of the AOV; passes that it does not need are culled.
    fn aov_image<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
        output: &PipelineOutput<'f>,
    ) -> Result<Texture, Error> {
        let missing = |output| Error::MissingOutput {
            aov: self.aov.to_string(),
            pipeline: self.config.pipeline.name().into(),
            output,
        };
        let (size_px, blit) = (view.options.size_px, &self.debug_blit);
        let buffers = || output.view.as_ref().ok_or_else(|| missing("view"));
        match &self.aov {
            Aov::Color => Ok(output.image.clone()),
            Aov::Visibility(_) | Aov::Cascade | Aov::Pages | Aov::Normal => {
                output.light.clone().ok_or_else(|| missing("light"))
            }
            Aov::Depth => {
                let depth = output.depth.as_ref().ok_or_else(|| missing("depth"))?;
                let buffers = buffers()?;
                Ok(frame.node("image", |frame| blit.depth(frame, buffers, depth, size_px)))
            }
            Aov::Atlas => {
                let maps: Vec<&Texture> = output.shadows.debug.iter().map(|(_, texture)| texture).collect();
                let buffers = buffers()?;
                Ok(frame.node("image", |frame| blit.textures(frame, buffers, &maps, size_px)))
            }
            Aov::Texture(name) => {
                let texture = frame.find_texture(name).ok_or_else(|| unknown_texture(frame, name))?;
                check_displayable(frame, &texture, name)?;
                let buffers = buffers()?;
                Ok(frame.node("image", |frame| blit.textures(frame, buffers, &[&texture], size_px)))
            }
        }
    }
}

/// The outputs of a view, for passes that follow it.
pub struct ViewOutput<'f> {
    /// Four bytes per pixel, as large as the view.
    pub image: Texture,
    /// The camera and the lights; `None` for a pipeline that does not output them.
    pub view: Option<ViewBuffers>,
    /// The shadows; empty for a pipeline without shadows.
    pub shadows: ShadowOutputs<'f>,
}

/// Refuses integer textures.
fn check_displayable(frame: &Frame<'_>, texture: &Texture, name: &str) -> Result<(), Error> {
    let desc = frame.texture_desc(texture);
    let Some(format) = desc.map(|desc| desc.format).filter(|format| !format.is_depth_stencil_format()) else {
        return Ok(());
    };
    match format.sample_type(None, None) {
        Some(wgpu::TextureSampleType::Float { .. }) => Ok(()),
        _ => Err(Error::NotDisplayable { name: name.into(), format }),
    }
}

fn unknown_texture(frame: &Frame<'_>, name: &str) -> Error {
    let textures = frame.texture_names().filter(|name| !Aov::NAMES.contains(name));
    let hint = did_you_mean(name, Aov::NAMES.into_iter().chain(textures));
    Error::UnknownTexture { name: name.into(), hint }
}

/// Returns what the lit passes write for an AOV, and in which format.
pub(super) fn lit_output(aov: &Aov, lights: &[Light]) -> Result<(LitOutput, Format), Error> {
    Ok(match aov {
        Aov::Visibility(light) if *light as usize >= lights.len() => {
            let lights = match lights.len() {
                0 => "the scene has no light".into(),
                1 => "the scene has one light, 0".into(),
                count => format!("the scene has lights 0 to {}", count - 1),
            };
            return Err(Error::UnknownLight { light: *light, lights });
        }
        Aov::Visibility(light) => (LitOutput::Visibility(*light), Format::Rgba8Unorm),
        Aov::Cascade | Aov::Pages => (LitOutput::Debug, Format::Rgba8Unorm),
        Aov::Normal => (LitOutput::Normal, Format::Rgba8Unorm),
        Aov::Color | Aov::Depth | Aov::Atlas | Aov::Texture(_) => (LitOutput::Light, Format::Rgba16Float),
    })
}
