//! What pipelines have in common.

use shadowgraph_core::{Frame, Texture, TextureDesc};
use shadowgraph_lighting::{Geometry, ViewBuffers, ViewRecords};
use shadowgraph_shadows::{ShadowInputs, ShadowOutputs};

use super::{Output, View};
use crate::options::Aov;
use crate::renderer::PICTURE_FORMAT;
use crate::{Error, Renderer};

/// The camera and the lights.
pub(super) fn records(renderer: &Renderer, view: &View<'_>) -> ViewRecords {
    let options = view.options;
    let lights = &renderer.scene().lights;
    let origin_world = renderer.casters.scene.origin_world();
    ViewRecords::new(&options.camera, options.size_px, lights, origin_world, &view.ambience)
}

/// What is drawn.
pub(super) fn geometry<'f>(renderer: &'f Renderer, view: &'f View<'f>) -> Geometry<'f> {
    Geometry { scene: &renderer.casters.scene, draws: &view.draws, size_px: view.options.size_px }
}

/// What shadows are made for.
pub(super) fn inputs<'f>(renderer: &'f Renderer, view: &'f View<'f>) -> ShadowInputs<'f> {
    let options = view.options;
    ShadowInputs {
        view: view.number,
        camera: renderer.shadow_camera.as_ref().unwrap_or(&options.camera),
        aspect: options.aspect(),
        lights: &renderer.scene().lights,
        casters: &renderer.casters,
        origin_world: renderer.casters.scene.origin_world(),
        settings: &options.shadows,
    }
}

/// What is where nothing is drawn: only pictures have a sky.
pub(super) fn background(renderer: &Renderer, view: &View<'_>) -> [f64; 4] {
    let is_data = matches!(renderer.aov(), Aov::Visibility(_) | Aov::Cascade | Aov::Normal);
    if is_data { [0.0; 4] } else { view.ambience.background() }
}

/// Adds what makes the picture; what the output does not need is culled.
pub(super) fn picture<'f>(
    frame: &mut Frame<'f>,
    renderer: &'f Renderer,
    view: &'f View<'f>,
    buffers: &ViewBuffers,
    shadows: ShadowOutputs<'f>,
    [lit, depth]: [Texture; 2],
) -> Result<Output, Error> {
    let size_px = view.options.size_px;
    let show = &renderer.show;
    let picture = frame.node("picture", |frame| match renderer.aov() {
        Aov::Color => {
            let mut picture = view.target.add_to(frame, size_px, PICTURE_FORMAT);
            view.target.tonemap.add_to(frame, &lit, &mut picture);
            Ok(picture)
        }
        Aov::Visibility(_) | Aov::Cascade | Aov::Normal => Ok(lit),
        Aov::Depth => Ok(show.depth(frame, buffers, &depth, size_px)),
        Aov::Atlas => Ok(show.textures(frame, buffers, &maps(&shadows), size_px)),
        Aov::Texture(name) => {
            let mut picture =
                frame.create_texture("picture", TextureDesc::d2(size_px[0], size_px[1], PICTURE_FORMAT));
            view.target.tonemap.add_to(frame, &lit, &mut picture);
            let texture = frame.find_texture(name).ok_or_else(|| no_texture(frame, name))?;
            Ok(show.textures(frame, buffers, &[&texture], size_px))
        }
    });
    let (records, unshadowed) = (shadows.records, shadows.unshadowed);
    picture.map(|picture| Output { picture, records, unshadowed })
}

fn maps<'s>(shadows: &'s ShadowOutputs<'_>) -> Vec<&'s Texture> {
    shadows.debug.iter().map(|(_, texture)| texture).collect()
}

fn no_texture(frame: &Frame<'_>, name: &str) -> Error {
    let known: Vec<_> = frame.texture_names().collect();
    Error::NoTexture { name: name.into(), known: known.join(", ") }
}
