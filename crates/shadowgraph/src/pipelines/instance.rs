//! Pipelines that are built for a device.

use shadowgraph_core::{Frame, Texture};
use shadowgraph_lighting::ViewBuffers;
use shadowgraph_shadows::ShadowOutputs;

use crate::error::Error;
use crate::render_view::RenderView;

/// A pipeline that is built for a device: adds all passes of a view to a frame, and keeps what they need from frame to frame.
pub trait PipelineInstance: Send + Sync {
    /// Adds the passes.
    ///
    /// # Errors
    /// For settings out of range, and for a view that the pipeline cannot draw.
    fn add<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        view: &'f RenderView<'f>,
    ) -> Result<PipelineOutput<'f>, Error>;

    /// Returns whether a node averages frames, as temporal anti-aliasing does: then noise changes from frame to frame, and its
    /// average converges. The default is `false`: the same view gives the same image in every frame.
    fn is_temporal(&self) -> bool {
        false
    }
}

/// The outputs of a pipeline for one view.
pub struct PipelineOutput<'f> {
    /// The finished image, as large as the view; a pipeline file calls it `image`.
    pub image: Texture,
    /// The output of lit passes, for AOVs that show it.
    pub light: Option<Texture>,
    /// The camera's depth.
    pub depth: Option<Texture>,
    /// The camera and the lights.
    pub view: Option<ViewBuffers>,
    /// The shadows; empty for a pipeline without shadows.
    pub shadows: ShadowOutputs<'f>,
}
