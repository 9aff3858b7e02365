//! `forward`: a depth prepass, shadows, one lit pass, a tonemap.

use shadowgraph_core::{Frame, Texture, TextureDesc};
use shadowgraph_lighting::{Geometry, ViewRecords};
use shadowgraph_shadows::{ShadowInputs, ShadowOutputs};

use super::{Output, View};
use crate::options::Aov;
use crate::renderer::PICTURE_FORMAT;
use crate::{Error, Renderer};

/// Adds all passes of a view to a frame.
///
/// # Errors
/// Shadow settings out of range, or an output that the frame does not have.
pub fn forward<'f>(
    frame: &mut Frame<'f>,
    renderer: &'f Renderer,
    view: &'f View<'f>,
) -> Result<Output, Error> {
    let Renderer { casters, technique, forward, surfaces, show, .. } = renderer;
    let options = view.options;
    let size_px = options.size_px;
    let lights = &renderer.scene().lights;
    let origin_world = casters.scene.origin_world();

    // The camera and the lights, for every shader.
    let records = ViewRecords::new(&options.camera, size_px, lights, origin_world, &view.ambience);
    let buffers = records.upload(frame);

    // What is seen: its depth, and where a technique asks for it, its surfaces.
    let geometry = Geometry { scene: &casters.scene, draws: &view.draws, size_px };
    let (depth, screen) = frame.node("geometry", |frame| {
        let depth = forward.prepass(frame, &buffers, geometry);
        let screen = surfaces.as_ref().map(|drawer| drawer.screen(frame, &buffers, &depth, geometry));
        screen.transpose().map(|screen| (depth, screen))
    })?;

    // Shadows, by whatever technique.
    let aspect = f64::from(size_px[0]) / f64::from(size_px[1]);
    let (camera, settings) = (&options.camera, &options.shadows);
    let inputs = ShadowInputs { view: 0, camera, aspect, lights, casters, origin_world, settings };
    let shadows = technique.add_to(frame, &inputs, screen.as_ref())?;

    // The lit scene. Only pictures have a sky: in the others nothing is where nothing is drawn.
    let is_data = matches!(renderer.aov(), Aov::Visibility(_) | Aov::Cascade | Aov::Normal);
    let background = if is_data { [0.0; 4] } else { view.ambience.background() };
    let lit = frame
        .node("lighting", |frame| forward.lit(frame, &buffers, &shadows, &depth, geometry, background))?;

    // The picture. What an output does not need is culled.
    let picture = frame.node("picture", |frame| match renderer.aov() {
        Aov::Color => {
            let mut picture = view.target.add_to(frame, size_px, PICTURE_FORMAT);
            view.target.tonemap.add_to(frame, &lit, &mut picture);
            Ok(picture)
        }
        Aov::Visibility(_) | Aov::Cascade | Aov::Normal => Ok(lit),
        Aov::Depth => Ok(show.depth(frame, &buffers, &depth, size_px)),
        Aov::Atlas => Ok(show.textures(frame, &buffers, &maps(&shadows), size_px)),
        Aov::Texture(name) => {
            let mut picture =
                frame.create_texture("picture", TextureDesc::d2(size_px[0], size_px[1], PICTURE_FORMAT));
            view.target.tonemap.add_to(frame, &lit, &mut picture);
            let texture = frame.find_texture(name).ok_or_else(|| no_texture(frame, name))?;
            Ok(show.textures(frame, &buffers, &[&texture], size_px))
        }
    });
    picture.map(|picture| Output { picture, unshadowed: shadows.unshadowed })
}

fn maps<'s>(shadows: &'s ShadowOutputs<'_>) -> Vec<&'s Texture> {
    shadows.debug.iter().map(|(_, texture)| texture).collect()
}

fn no_texture(frame: &Frame<'_>, name: &str) -> Error {
    let known: Vec<_> = frame.texture_names().collect();
    Error::NoTexture { name: name.into(), known: known.join(", ") }
}
