//! Looking into a frame: what its passes wrote, and how long they took.

mod above;
pub(crate) mod lights;

use shadowgraph_core::{Buffer, FrameCapture, HtmlPage, PendingCapture, TextureSnapshot, Timer};
use shadowgraph_scene::Light;
use shadowgraph_shadows::{ShadowLight, ShadowView};

use crate::{Drawn, Error, Gpu, Renderer, ViewOptions};

/// A drawn view with what its passes wrote.
#[derive(Debug)]
pub struct Inspected {
    /// The view as it is always drawn, with times.
    pub drawn: Drawn,
    /// Every texture of its frame, behind each pass that wrote it.
    pub pictures: Vec<TextureSnapshot>,
    /// The records that its shadow maps are drawn by; none of a technique without maps.
    pub views: Vec<ShadowView>,
    /// Which of them lights have, by light; none of a technique without maps.
    pub lights: Vec<ShadowLight>,
}

impl Renderer {
    /// Draws a view as [`draw`](Self::draw) does, measures it, and draws it once more to take pictures of all that its
    /// passes write.
    ///
    /// # Errors
    /// As `draw`.
    pub fn inspect(&mut self, gpu: &Gpu, options: &ViewOptions) -> Result<Inspected, Error> {
        // A driver may compile shaders at the first draw.
        self.draw(gpu, options)?;
        let drawn = self.draw_timed(gpu, options, Some(&mut Timer::new()))?;
        let mut capture: Option<PendingCapture> = None;
        let (_, records) = self.draw_by(gpu, options, |compiled, graph, encoder| {
            let (executed, taken) = compiled.execute_captured(graph, &gpu.device, encoder)?;
            capture = Some(taken);
            Ok(executed)
        })?;
        let captured = match capture {
            Some(capture) => capture.wait(&gpu.device)?,
            None => FrameCapture::default(),
        };
        let (views, lights) = match &records {
            Some([views, lights]) => (records_of(&captured, views), records_of(&captured, lights)),
            None => (Vec::new(), Vec::new()),
        };
        Ok(Inspected { drawn, pictures: captured.textures, views, lights })
    }
}

impl Inspected {
    /// Returns the page about the frame: its plan, times and pictures, its lights, and where its shadow maps look.
    pub fn page(&self, scene_lights: &[Light], options: &ViewOptions) -> HtmlPage<'_> {
        let mut page = self.drawn.page(scene_lights);
        page.snapshots.clone_from(&self.pictures);
        page.drawings.extend(above::from_above(self, scene_lights, options));
        page
    }
}

/// The last bytes of a buffer, as records. A buffer may be larger than what is in it.
fn records_of<R: bytemuck::AnyBitPattern>(captured: &FrameCapture, buffer: &Buffer) -> Vec<R> {
    let last = captured.buffers.iter().rev().find(|(id, _)| *id == buffer.id());
    let bytes = last.map_or(&[][..], |(_, bytes)| bytes);
    bytes.chunks_exact(size_of::<R>()).map(bytemuck::pod_read_unaligned).collect()
}
