//! Pipelines: scripts that wire nodes together, one call per step. Copy one and edit it.

mod forward;
mod minimal;
mod steps;

pub use forward::forward;
pub use minimal::minimal;
use steps::{background, geometry, inputs, picture, records};

use shadowgraph_core::{Buffer, Format, Frame, Texture, TextureDesc};
use shadowgraph_lighting::{Ambience, Tonemap};
use shadowgraph_scene::gpu::DrawList;
use shadowgraph_shadows::Unshadowed;

use crate::options::Pipeline;
use crate::{Error, Renderer, ViewOptions};

/// Adds the passes of the renderer's own pipeline.
///
/// # Errors
/// Shadow settings out of range, or an output that the frame does not have.
pub fn add<'f>(frame: &mut Frame<'f>, renderer: &'f Renderer, view: &'f View<'f>) -> Result<Output, Error> {
    match renderer.pipeline() {
        Pipeline::Forward | Pipeline::ScreenShadows => forward(frame, renderer, view),
        Pipeline::Minimal => minimal(frame, renderer, view),
    }
}

/// One view of a frame.
pub struct View<'v> {
    /// Which of the frame's views it is, from 0.
    pub number: u32,
    /// Who looks, and how.
    pub options: &'v ViewOptions,
    /// What of the scene is seen.
    pub draws: DrawList,
    /// The light from all around, and the exposure.
    pub ambience: Ambience,
    /// Where a colour picture goes.
    pub target: Target<'v>,
}

/// Where a colour picture goes.
#[derive(Clone, Copy)]
pub struct Target<'v> {
    /// A texture of the caller's, as large as the view; `None`: a texture of the frame.
    pub texture: Option<&'v wgpu::Texture>,
    /// The tonemap for its format.
    pub tonemap: &'v Tonemap,
}

impl Target<'_> {
    /// Imports the caller's texture, or creates one of the frame.
    pub fn add_to(&self, frame: &mut Frame<'_>, size_px: [u32; 2], format: Format) -> Texture {
        match self.texture {
            Some(texture) => frame.import_texture("target", texture, false),
            None => frame.create_texture("picture", TextureDesc::d2(size_px[0], size_px[1], format)),
        }
    }
}

/// What a pipeline gives.
pub struct Output {
    /// Four bytes a pixel, as large as the view.
    pub picture: Texture,
    /// The records of shadow maps, where there are any.
    pub records: Option<[Buffer; 2]>,
    /// The lights that are to cast shadows but have none, and why.
    pub unshadowed: Vec<Unshadowed>,
}
