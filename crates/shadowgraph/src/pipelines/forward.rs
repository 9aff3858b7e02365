//! `forward`: a depth prepass, shadows, one lit pass, a tonemap.
//!
//! `screen_shadows` is the same with a technique that collects its shadows in a screen mask.

use shadowgraph_core::Frame;
use shadowgraph_shadows::add_shadows;

use super::{Output, View, background, geometry, inputs, picture, records};
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
    let Renderer { technique, forward, surfaces, .. } = renderer;

    // The camera and the lights, for every shader.
    let buffers = records(renderer, view).upload(frame);

    // What is seen: its depth, and where a technique asks for it, its surfaces.
    let geometry = geometry(renderer, view);
    let (depth, screen) = frame.node("geometry", |frame| {
        let depth = forward.prepass(frame, &buffers, geometry);
        let screen = surfaces.as_ref().map(|drawer| match renderer.samples() {
            1 => drawer.screen(frame, &buffers, &depth, geometry),
            _ => drawer.screen_alone(frame, &buffers, geometry),
        });
        screen.transpose().map(|screen| (depth, screen))
    })?;

    // Shadows, by whatever technique.
    let shadows = add_shadows(technique.as_ref(), frame, &inputs(renderer, view), screen.as_ref())?;

    // The lit scene.
    let background = background(renderer, view);
    let lit = frame
        .node("lighting", |frame| forward.lit(frame, &buffers, &shadows, &depth, geometry, background))?;
    picture(frame, renderer, view, &buffers, shadows, [lit, depth])
}
