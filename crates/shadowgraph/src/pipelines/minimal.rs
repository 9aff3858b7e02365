//! `minimal`: shadows, one lit pass without a depth prepass, a tonemap.

use shadowgraph_core::Frame;
use shadowgraph_shadows::add_shadows;

use super::{Output, View, background, geometry, inputs, picture, records};
use crate::{Error, Renderer};

/// Adds all passes of a view to a frame.
///
/// # Errors
/// Shadow settings out of range, or an output that the frame does not have.
pub fn minimal<'f>(
    frame: &mut Frame<'f>,
    renderer: &'f Renderer,
    view: &'f View<'f>,
) -> Result<Output, Error> {
    let Renderer { technique, forward, surfaces, .. } = renderer;
    let buffers = records(renderer, view).upload(frame);
    let geometry = geometry(renderer, view);

    // A technique that asks for surfaces needs them before anything is lit.
    let screen = surfaces.as_ref().map(|drawer| drawer.screen_alone(frame, &buffers, geometry));
    let screen = screen.transpose()?;

    // Shadows, by whatever technique.
    let shadows = add_shadows(technique.as_ref(), frame, &inputs(renderer, view), screen.as_ref())?;

    // The lit scene.
    let background = background(renderer, view);
    let (lit, depth) = frame.node("lighting", |frame| {
        forward.lit_without_prepass(frame, &buffers, &shadows, geometry, background)
    })?;
    picture(frame, renderer, view, &buffers, shadows, [lit, depth])
}
